// A run that is killed leaves whole frames only, and the next one goes on where it was.
#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <thread>

#include "tests/sequence/shot_folder.h"

namespace pellucid {
namespace {

using namespace test;
namespace fs = std::filesystem;

class Resume : public ShotFolder {
 protected:
  std::vector<std::string> jobInto(const std::string& output, int jobs) const {
    return {"composite", "shot.####.exr", "glass.glb",       "-o",     output,
            "--frames",  "1001-1006",     "--skip-existing", "--jobs", std::to_string(jobs)};
  }
};

// PELLUCID_KILLS says how often; a few times tell of every stage of a frame sooner or later.
TEST_F(Resume, KilledAtAnyMomentTheFramesAreThoseOfAnUndisturbedRun) {
  makeShot({1001, 1002, 1003, 1004, 1005, 1006}, "bottles");
  const Ended whole = run(jobInto("whole.####.exr", 1));
  ASSERT_EQ(whole.code, 0) << whole.err;
  const char* often = std::getenv("PELLUCID_KILLS");
  const int kills = often ? std::atoi(often) : 4;
  const int longest = std::max(static_cast<int>(1e3 * whole.seconds), 1);
  std::uint32_t random = 20231;
  int unfinished = 0;
  for (int i = 0; i < kills; ++i) {
    for (int frame = 1001; frame <= 1006; ++frame) fs::remove(folder + "/out." + std::to_string(frame) + ".exr");
    random = random * 1664525u + 1013904223u;
    RunOptions killed = options;
    killed.interruptAfterMs = static_cast<int>(random >> 8) % longest;
    killed.signal = i % 2 ? SIGKILL : SIGTERM;
    const std::vector<std::string> job = jobInto("out.####.exr", 1 + i % 2);
    const int code = runProgram(job, killed).code;
    EXPECT_TRUE(code == 0 || code == 128 + killed.signal) << code;
    int found = 0;
    for (int frame = 1001; frame <= 1006; ++frame) {
      const std::string name = "." + std::to_string(frame) + ".exr";
      if (!there("out" + name)) continue;
      ++found;
      EXPECT_TRUE(bytes("out" + name) == bytes("whole" + name)) << name << " after " << killed.interruptAfterMs;
    }
    if (found < 6) ++unfinished;
    ASSERT_EQ(run(job).code, 0);
    for (int frame = 1001; frame <= 1006; ++frame) {
      const std::string name = "." + std::to_string(frame) + ".exr";
      EXPECT_TRUE(bytes("out" + name) == bytes("whole" + name)) << name << " after " << killed.interruptAfterMs;
    }
  }
  std::printf("%d of %d runs were killed before their end\n", unfinished, kills);
  EXPECT_GT(unfinished, 0);
}

TEST_F(Resume, TwoRunsOnOneFolderDoNoHarm) {
  makeShot({1001, 1002, 1003, 1004, 1005, 1006});
  ASSERT_EQ(run(jobInto("whole.####.exr", 1)).code, 0);
  Ended first;
  std::thread beside([&] { first = run(jobInto("out.####.exr", 1)); });
  const Ended second = run(jobInto("out.####.exr", 2));
  beside.join();
  EXPECT_EQ(first.code, 0) << first.err;
  EXPECT_EQ(second.code, 0) << second.err;
  for (int frame = 1001; frame <= 1006; ++frame) {
    const std::string name = "." + std::to_string(frame) + ".exr";
    EXPECT_TRUE(bytes("out" + name) == bytes("whole" + name)) << name;
  }
  EXPECT_TRUE(debris().empty());
}

}  // namespace
}  // namespace pellucid
