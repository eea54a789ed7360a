// Frames of a shot by the program, as a user runs it.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>

#include "composite/sequence/digest.h"
#include "gbuffer/exr_document.h"
#include "tests/sequence/shot_folder.h"

namespace pellucid {
namespace {

using namespace test;
namespace fs = std::filesystem;

class Sequence : public ShotFolder {};

// Every frame by itself is the picture of the sequence, but for what its header says of the digest.
void expectSamePicture(const std::string& a, const std::string& b) {
  const Ended compared = runProgram({"compare", a, b, "--fail", "0"});
  EXPECT_EQ(compared.code, 0) << compared.out << compared.err;
}

TEST_F(Sequence, EveryFrameIsThatOfASingleRun) {
  makeShot({1001, 1002});
  // The second frame is another picture, so that a frame taken for the other would show.
  ASSERT_EQ(
      run({"composite", "shot.1001.exr", "glass.glb", "-o", "shot.1002.exr", "--method", "sum", "--aa", "1"}).code, 0);
  const Ended ended = composite({"--frames", "1001-1002"});
  EXPECT_EQ(ended.code, 0) << ended.err;
  for (const std::string frame : {"1001", "1002"}) {
    ASSERT_EQ(run({"composite", "shot." + frame + ".exr", "glass.glb", "-o", "one.exr", "--aa", "1"}).code, 0);
    expectSamePicture(folder + "/one.exr", folder + "/out." + frame + ".exr");
    expectIn("frame " + frame + ": done", ended.err);
  }
  EXPECT_FALSE(exrText(folder + "/one.exr", kDigestAttribute)) << "a picture by itself has no digest";
}

TEST_F(Sequence, WithoutFramesThoseOnDisk) {
  makeShot({1003, 1001});
  const Ended ended = composite({});
  EXPECT_EQ(ended.code, 0) << ended.err;
  expectIn("frames 1001, 1003: the 2 files of shot.####.exr", ended.err);
  EXPECT_TRUE(there("out.1001.exr"));
  EXPECT_TRUE(there("out.1003.exr"));
  const Ended none = run({"composite", "no.####.exr", "glass.glb", "-o", "out.####.exr"});
  EXPECT_EQ(none.code, 3) << none.err;
  expectIn("no.####.exr: found no file of that pattern", none.err);
}

TEST_F(Sequence, AMissingOrBrokenFrameIsAnErrorOfThatFrame) {
  makeShot({1001, 1002, 1003, 1004});
  fs::remove(folder + "/shot.1002.exr");
  fs::resize_file(folder + "/shot.1003.exr", 500);
  for (const std::string jobs : {"1", "2"}) {
    for (const std::string frame : {"1001", "1004"}) fs::remove(folder + "/out." + frame + ".exr");
    const Ended ended = composite({"--frames", "1001-1004", "--jobs", jobs});
    EXPECT_EQ(ended.code, 5) << ended.err;
    EXPECT_TRUE(there("out.1001.exr"));
    EXPECT_TRUE(there("out.1004.exr"));
    EXPECT_FALSE(there("out.1002.exr"));
    EXPECT_FALSE(there("out.1003.exr"));
    expectIn("1002   3     shot.1002.exr", ended.err);
    expectIn("1003   3     shot.1003.exr", ended.err);
    expectIn("2 of 4 frames failed: 1002, 1003", ended.err);
    EXPECT_TRUE(debris().empty());
  }
  // One frame alone ends with the code of what is wrong with it.
  EXPECT_EQ(composite({"--frames", "1002"}).code, 3);
}

TEST_F(Sequence, RefusedBeforeAnyWork) {
  makeShot({1001, 1002});
  const std::vector<std::string> before = filesIn(folder);
  const auto refused = [&](const std::vector<std::string>& arguments, int code, const std::string& sentence) {
    const Ended ended = run(arguments);
    EXPECT_EQ(ended.code, code) << ended.err;
    expectIn(sentence, ended.err);
    EXPECT_EQ(filesIn(folder), before) << "nothing was written";
  };
  const std::string in = "shot.####.exr", glass = "glass.glb";
  refused({"composite", in, glass, "-o", "out.exr", "--frames", "1001-1002"}, 2,
          "--output: found 'out.exr' for 2 frames");
  refused({"composite", in, glass, "-o", "out.####.exr", "--preview", "p.png", "--frames", "1001-1002"}, 2,
          "--preview: found 'p.png' for 2 frames");
  refused({"composite", in, glass, "-o", "shot.%04d.exr", "--frames", "1001-1002"}, 2, "which is also an input");
  refused({"composite", in, glass, "-o", "no/out.####.exr", "--frames", "1001-1002"}, 6, "cannot be written in folder");
  refused({"composite", in, glass, "-o", "out.####.png", "--frames", "1001-1002"}, 2, "ends in .exr");
  refused({"composite", in, glass, "-o", "out.####.exr", "--frames", "1001-"}, 2, "--frames: found '1001-'");
  refused({"composite", "shot.1001.exr", glass, "-o", "out.####.exr"}, 2, "expected --frames");
  refused({"composite", "shot.1001.exr", glass, "-o", "out.exr", "--jobs", "2"}, 2, "--jobs");
  refused({"composite", in, glass, "-o", "out.####.exr", "--frames", "1001-1002", "--frame", "3"}, 2, "--frame");
  // What no frame can honour is said once, and no frame is tried after the first.
  refused({"composite", in, glass, "-o", "out.####.exr", "--frames", "1001-1002", "--method", "sum", "--resolve", "gl"},
          2, "--resolve: found gl with --method sum");
}

TEST_F(Sequence, DuplicatesAreSaidAndMadeOnce) {
  makeShot({1001, 1002});
  const Ended ended = composite({"--frames", "1002,1001-1002"});
  EXPECT_EQ(ended.code, 0) << ended.err;
  expectIn("--frames: found 1002 more than once", ended.err);
  expectIn("(2 of 2)", ended.err);
}

TEST_F(Sequence, WhatIsDoneIsSkippedAndWhatChangedIsRedone) {
  makeShot({1001, 1002, 1003});
  fs::copy_file(folder + "/glass.glb", folder + "/glass.1001.glb");
  ASSERT_EQ(composite({"--frames", "1001-1003"}).code, 0);
  const std::string first = bytes("out.1001.exr");
  const auto again = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"--frames", "1001-1003", "--skip-existing"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Ended ended = composite(arguments);
    EXPECT_EQ(ended.code, 0) << ended.err;
    std::string skipped;
    for (const std::string frame : {"1001", "1002", "1003"})
      if (ended.err.find("frame " + frame + ": skipped") != std::string::npos) skipped += frame + " ";
    return skipped;
  };
  EXPECT_EQ(again({}), "1001 1002 1003 ");
  EXPECT_EQ(again({"--threads", "1", "--budget", "64M", "--jobs", "2", "--progress", "plain"}), "1001 1002 1003 ")
      << "none of these changes a bit";
  fs::remove(folder + "/out.1002.exr");
  EXPECT_EQ(again({}), "1001 1003 ");
  fs::resize_file(folder + "/out.1002.exr", 100);
  EXPECT_EQ(again({}), "1001 1003 ") << "what is there is no picture";
  EXPECT_EQ(again({"--mask", "hard"}), "") << "a flag";
  EXPECT_EQ(again({"--mask", "hard"}), "1001 1002 1003 ");
  // An input: the picture of one frame.
  ASSERT_EQ(
      run({"composite", "shot.1001.exr", "glass.glb", "-o", "shot.1003.exr", "--method", "sum", "--aa", "1"}).code, 0);
  EXPECT_EQ(again({"--mask", "hard"}), "1001 1002 ");
  EXPECT_EQ(again({}), "") << "back to the first flags";
  EXPECT_EQ(bytes("out.1001.exr"), first) << "the same bytes";
}

TEST_F(Sequence, ATextureThatAGltfNamesCounts) {
  makeShot({1001});
  const nlohmann::json scene{{"asset", {{"version", "2.0"}}}, {"images", {{{"uri", "a%20b.png"}}}}};
  std::ofstream(folder + "/glass.gltf") << scene.dump();
  std::ofstream(folder + "/a b.png") << "one";
  FileDigests digests;
  const auto skips = [&] {
    return run({"composite", "shot.####.exr", "glass.gltf", "-o", "out.####.exr", "--aa", "1", "--skip-existing",
                "--frames", "1001", "--camera", "eye=0,1,5;look=0,0,0;fov=40"})
               .err.find("skipped") != std::string::npos;
  };
  EXPECT_FALSE(skips());
  EXPECT_TRUE(skips());
  std::ofstream(folder + "/a b.png") << "two";
  EXPECT_FALSE(skips());
}

TEST_F(Sequence, SideBySideGivesTheSameBytes) {
  makeShot({1, 2, 3, 4, 5}, "bottles");
  ASSERT_EQ(composite({"--frames", "1-5", "-o", "one.####.exr"}).code, 2) << "--output is given once";
  const std::vector<std::string> job{"composite", "shot.%d.exr", "glass.glb", "--frames", "1-5", "--aa", "2"};
  const auto into = [&](const std::string& output, const std::string& jobs) {
    std::vector<std::string> arguments = job;
    arguments.insert(arguments.end(), {"-o", output, "--jobs", jobs});
    return run(arguments).code;
  };
  ASSERT_EQ(into("one.####.exr", "1"), 0);
  ASSERT_EQ(into("many.####.exr", "3"), 0);
  for (int frame = 1; frame <= 5; ++frame) {
    const std::string name = ".000" + std::to_string(frame) + ".exr";
    EXPECT_TRUE(bytes("one" + name) == bytes("many" + name)) << name;
  }
}

TEST_F(Sequence, OneWeightForTheWholeShot) {
  makeShot({1001, 1002, 1003}, "bottles");
  const std::vector<std::string> fit{"--frames", "1001-1003", "--method", "phenomenological",
                                     "--weight", "auto",      "--jobs",   "2"};
  const Ended ended = composite(fit);
  ASSERT_EQ(ended.code, 0) << ended.err;
  expectIn("frame 1001: the weight fitted to this frame is that of all frames", ended.err);
  const auto weight = exrText(folder + "/out.1001.exr", "pellucid:weight");
  ASSERT_TRUE(weight);
  for (const std::string frame : {"1002", "1003"})
    EXPECT_EQ(exrText(folder + "/out." + frame + ".exr", "pellucid:weight"), weight);
  std::vector<std::string> again = fit;
  again.push_back("--skip-existing");
  const Ended skipped = composite(again);
  for (const std::string frame : {"1001", "1002", "1003"}) expectIn("frame " + frame + ": skipped", skipped.err);
}

TEST_F(Sequence, ResultsAsJson) {
  makeShot({1001, 1002});
  fs::remove(folder + "/shot.1002.exr");
  const Ended ended = composite({"--frames", "1001-1002", "--json", "--measure", "--log-json"});
  EXPECT_EQ(ended.code, 5);
  const nlohmann::json report = nlohmann::json::parse(ended.out);
  ASSERT_EQ(report["frames"].size(), 2u);
  EXPECT_EQ(report["frames"][0]["state"], "done");
  EXPECT_EQ(report["frames"][0]["report"]["output"], "out.1001.exr");
  EXPECT_EQ(report["frames"][1]["state"], "failed");
  EXPECT_EQ(report["frames"][1]["error"]["code"], 3);
  std::istringstream lines(ended.err);
  std::size_t parsed = 0;
  for (std::string line; std::getline(lines, line); ++parsed) {
    const nlohmann::json entry = nlohmann::json::parse(line, nullptr, false);
    ASSERT_TRUE(entry.is_object()) << line;
    EXPECT_TRUE(entry.contains("level") && entry.contains("message") && entry.contains("time")) << line;
  }
  EXPECT_GT(parsed, 2u);
}

TEST_F(Sequence, ProgressOfEveryForm) {
  makeShot({1001, 1002});
  const auto said = [&](const std::string& form) {
    const Ended ended = composite({"--frames", "1001-1002", "--progress", form});
    EXPECT_EQ(ended.code, 0) << ended.err;
    return ended.err;
  };
  EXPECT_EQ(said("none").find("done"), std::string::npos);
  expectIn("pellucid: frame 1002: done in ", said("plain"));
  expectIn("openjd_progress: 100\nopenjd_status: frame 1002: done\n", said("openjd"));
  expectIn("\"state\":\"done\"", said("json"));
  const Ended single =
      run({"composite", "shot.1001.exr", "glass.glb", "-o", "one.exr", "--aa", "16", "--progress", "openjd"});
  expectIn("openjd_progress: 100\n", single.err);
}

}  // namespace
}  // namespace pellucid
