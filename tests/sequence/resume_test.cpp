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

const std::vector<int> kFrames{1001, 1002, 1003, 1004};

class Resume : public ShotFolder {
 protected:
  std::vector<std::string> jobInto(const std::string& output, int jobs) const {
    return {"composite", "shot.####.exr",   "glass.glb", "-o", output,   "--frames",
            "1001-1004", "--skip-existing", "--aa",      "1",  "--jobs", std::to_string(jobs)};
  }
  static std::string nameOf(const std::string& shot, int frame) { return shot + "." + std::to_string(frame) + ".exr"; }
  // How many frames of `out` are there. Each has to have the bytes of the same frame of that shot.
  int framesLikeThoseOf(const std::string& shot) const {
    int found = 0;
    for (const int frame : kFrames) {
      if (!there(nameOf("out", frame))) continue;
      ++found;
      EXPECT_TRUE(bytes(nameOf("out", frame)) == bytes(nameOf(shot, frame))) << frame;
    }
    return found;
  }
};

// Every run goes on where the one before it was killed, until all frames are there; then it starts over. PELLUCID_KILLS
// says how many runs must have been killed in the end.
TEST_F(Resume, KilledFiftyTimesTheFramesAreThoseOfAnUndisturbedRun) {
  makeShot(kFrames, "bars", "45");
  const Ended whole = run(jobInto("whole.####.exr", 1));
  ASSERT_EQ(whole.code, 0) << whole.err;
  const char* often = std::getenv("PELLUCID_KILLS");
  const int wanted = often ? std::atoi(often) : 50;
  const int longest = std::max(static_cast<int>(1e3 * whole.seconds), 1);
  std::uint32_t random = 20231;
  int kills = 0, shots = 0, resumed = 0;
  for (int i = 0; kills < wanted; ++i) {
    ASSERT_LT(i, 10 * wanted) << "hardly a run was killed";
    random = random * 1664525u + 1013904223u;
    RunOptions killed = options;
    killed.interruptAfterMs = static_cast<int>(random >> 8) % longest;
    killed.signal = i % 4 < 2 ? SIGTERM : SIGKILL;
    const int before = framesLikeThoseOf("whole");
    const Ended ended = runProgram(jobInto("out.####.exr", 1 + i % 2), killed);
    ASSERT_TRUE(ended.code == 0 || ended.code == 128 + killed.signal) << ended.code << ": " << ended.err;
    kills += ended.code != 0;
    const int after = framesLikeThoseOf("whole");
    EXPECT_GE(after, before) << "a frame that was whole is gone";
    resumed += before > 0 && after > before;
    if (ended.code != 0) continue;
    ASSERT_EQ(after, static_cast<int>(kFrames.size())) << "a run that ended well has left frames out";
    ++shots;
    for (const int frame : kFrames) fs::remove(folder + "/" + nameOf("out", frame));
  }
  std::printf(
      "[ figure ] %d runs killed within %d ms; %d shots finished, %d runs added frames to those of a killed one\n",
      kills, longest, shots, resumed);
  EXPECT_GT(shots, 0);
  EXPECT_GT(resumed, 0);
}

TEST_F(Resume, TwoRunsOnOneFolderDoNoHarm) {
  makeShot(kFrames);
  ASSERT_EQ(run(jobInto("whole.####.exr", 1)).code, 0);
  Ended first;
  std::thread beside([&] { first = run(jobInto("out.####.exr", 1)); });
  const Ended second = run(jobInto("out.####.exr", 2));
  beside.join();
  EXPECT_EQ(first.code, 0) << first.err;
  EXPECT_EQ(second.code, 0) << second.err;
  EXPECT_EQ(framesLikeThoseOf("whole"), static_cast<int>(kFrames.size()));
  EXPECT_TRUE(debris().empty());
}

}  // namespace
}  // namespace pellucid
