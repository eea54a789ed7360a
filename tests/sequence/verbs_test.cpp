// Every verb that reads or writes pictures takes patterns.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "gbuffer/exr_document.h"
#include "tests/sequence/shot_folder.h"

namespace pellucid {
namespace {

using namespace test;

class FrameVerbs : public ShotFolder {
 protected:
  void SetUp() override {
    ShotFolder::SetUp();
    makeShot({1001, 1002}, "bottles");
  }
  void works(std::vector<std::string> arguments, const std::vector<std::string>& files) {
    arguments.insert(arguments.end(), {"--frames", "1001-1002"});
    const Ended ended = run(arguments);
    EXPECT_EQ(ended.code, 0) << arguments[0] << ": " << ended.err;
    for (const std::string& file : files) EXPECT_TRUE(there(file)) << file;
    // What is done is left out the next time.
    arguments.push_back("--skip-existing");
    const Ended again = run(arguments);
    EXPECT_EQ(again.code, 0) << arguments[0] << ": " << again.err;
    expectIn("frame 1001: skipped", again.err);
    expectIn("frame 1002: skipped", again.err);
  }
};

TEST_F(FrameVerbs, TwoStepsDeepFilesAndRenders) {
  works({"accumulate", "shot.####.exr", "glass.glb", "-o", "planes.####.exr", "--aa", "2"},
        {"planes.1001.exr", "planes.1002.exr"});
  works({"resolve", "shot.####.exr", "planes.%04d.exr", "-o", "resolved.@@@@.exr", "--preview", "look.####.png"},
        {"resolved.1002.exr", "look.1001.png"});
  works({"fragments", "shot.####.exr", "glass.glb", "-o", "deep.$F4.exr"}, {"deep.1001.exr", "deep.1002.exr"});
  works({"flatten", "deep.####.exr", "-o", "flat.####.exr"}, {"flat.1001.exr", "flat.1002.exr"});
  works({"gbuffer", "glass.glb", "-o", "g.####.exr", "--size", "64x36", "--samples", "1"},
        {"g.1001.exr", "g.1002.exr"});
  // A deep file per frame as the transparent things.
  works({"composite", "shot.####.exr", "deep.####.exr", "-o", "out.####.exr", "--aa", "1"}, {"out.1002.exr"});
  // Side files too.
  works({"composite", "shot.####.exr", "glass.glb", "-o", "side.####.exr", "--aa", "1", "--depth", "shot.####.exr:Z",
         "--aov", "N=shot.####.exr"},
        {"side.1002.exr"});
}

TEST_F(FrameVerbs, InspectAndStudy) {
  const Ended text = run({"inspect", "shot.####.exr"});
  EXPECT_EQ(text.code, 0) << text.err;
  expectIn("\n1002  ", text.out);
  const nlohmann::json report = nlohmann::json::parse(run({"inspect", "shot.####.exr", "--json"}).out);
  EXPECT_EQ(report["frames"].size(), 2u);
  const Ended study = run({"study", "shot.####.exr", "glass.glb", "-o", "study", "--methods", "weighted,sum"});
  EXPECT_EQ(study.code, 0) << study.err;
  expectIn("worst frame", study.out);
  EXPECT_TRUE(there("study/1001/study.csv"));
  EXPECT_TRUE(there("study/1002/study.html"));
}

}  // namespace
}  // namespace pellucid
