// Every way to fail: the documented exit code, one sentence, and the old output whole.
#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <fstream>

#include "tests/support/exr_shots.h"
#include "tests/support/program.h"
#include "tests/support/shell.h"
#include "tests/support/shots.h"

namespace pellucid {
namespace {

using namespace test;

class Errors : public ::testing::Test {
 protected:
  void SetUp() override {
    folder = freshFolder(std::string("errors-") + ::testing::UnitTest::GetInstance()->current_test_info()->name());
    writeOpaque(folder + "/opaque.exr");
    writeGlb(folder + "/glass.glb", {Quad{{-1, -1, -3}, {2, 0, 0}, {0, 2, 0}, unlit(1, 0, 0, .5f)}});
    std::ofstream(folder + "/out.exr") << "the old output";
    before = filesIn(folder);
  }
  // The error line, after checking code and that nothing was lost or left.
  std::string expectFailure(const std::vector<std::string>& arguments, int code, RunOptions options = {}) {
    options.folder = folder;
    const Ended ended = runProgram(arguments, options);
    EXPECT_EQ(ended.code, code) << ended.err;
    EXPECT_EQ(slurp(folder + "/out.exr"), "the old output");
    EXPECT_EQ(filesIn(folder), before) << "debris";
    std::string line;
    int errors = 0;
    std::istringstream lines(ended.err);
    for (std::string each; std::getline(lines, each);)
      if (each.find("error:") != std::string::npos) ++errors, line = each;
    if (code != 130 && code != 143) {
      EXPECT_EQ(errors, 1) << ended.err;
    }
    return line;
  }
  std::vector<std::string> composite(const std::string& opaque, const std::string& glass,
                                     std::vector<std::string> more = {}) {
    std::vector<std::string> arguments{"composite", opaque, glass, "-o", "out.exr", "--aa", "1"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  }
  std::string folder;
  std::vector<std::string> before;
};

TEST_F(Errors, TheGoodCaseWorks) {
  RunOptions options;
  options.folder = folder;
  const Ended ended = runProgram(composite("opaque.exr", "glass.glb", {"--measure"}), options);
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_NE(slurp(folder + "/out.exr"), "the old output");
  EXPECT_NE(ended.out.find("rmse"), std::string::npos);
}

TEST_F(Errors, MissingFiles) {
  EXPECT_NE(expectFailure(composite("none.exr", "glass.glb"), 3).find("none.exr"), std::string::npos);
  EXPECT_NE(expectFailure(composite("opaque.exr", "none.glb"), 3).find("none.glb"), std::string::npos);
}

TEST_F(Errors, TruncatedAndWrongFiles) {
  const std::string whole = slurp(folder + "/opaque.exr");
  std::ofstream(folder + "/cut.exr", std::ios::binary) << whole.substr(0, whole.size() / 2);
  std::ofstream(folder + "/text.exr") << "not an image";
  std::ofstream(folder + "/text.glb") << "not a scene";
  before = filesIn(folder);
  EXPECT_NE(expectFailure(composite("cut.exr", "glass.glb"), 3).find("cut.exr"), std::string::npos);
  EXPECT_NE(expectFailure(composite("text.exr", "glass.glb"), 3).find("text.exr"), std::string::npos);
  EXPECT_NE(expectFailure(composite("opaque.exr", "text.glb"), 3).find("text.glb"), std::string::npos);
  EXPECT_NE(expectFailure(composite("glass.glb", "opaque.exr"), 3).find("glass.glb"), std::string::npos);  // swapped
}

TEST_F(Errors, NoDepthAndTwoDepths) {
  writeOpaque(folder + "/flat.exr", {.withDepth = false});
  writeOpaque(folder + "/two.exr", {.withSecondDepth = true});
  before = filesIn(folder);
  EXPECT_NE(expectFailure(composite("flat.exr", "glass.glb"), 4).find("depth"), std::string::npos);
  const std::string two = expectFailure(composite("two.exr", "glass.glb"), 4);
  EXPECT_NE(two.find("depth.Z"), std::string::npos) << two;
  EXPECT_NE(two.find("--depth"), std::string::npos) << two;
  RunOptions options;
  options.folder = folder;
  EXPECT_EQ(runProgram(composite("two.exr", "glass.glb", {"--depth", "depth.Z"}), options).code, 0);
}

TEST_F(Errors, NoCameraAndTwoCameras) {
  GlbOptions none;
  none.camera = false;
  writeGlb(folder + "/blind.glb", {Quad{}}, none);
  before = filesIn(folder);
  EXPECT_NE(expectFailure(composite("opaque.exr", "blind.glb"), 4).find("camera"), std::string::npos);
  GlbOptions wide;
  wide.yfov = 1.2;
  writeGlb(folder + "/wide.glb", {Quad{}}, wide);
  before = filesIn(folder);
  std::vector<std::string> both = composite("opaque.exr", "glass.glb");
  both.insert(both.begin() + 2, "wide.glb");
  EXPECT_NE(expectFailure(both, 4).find("2 cameras"), std::string::npos);
  both.insert(both.end(), {"--camera", "cam"});
  EXPECT_NE(expectFailure(both, 2).find("differ"), std::string::npos);
  EXPECT_NE(expectFailure(composite("opaque.exr", "glass.glb", {"--camera", "other"}), 2).find("other"),
            std::string::npos);
  RunOptions options;
  options.folder = folder;
  EXPECT_EQ(
      runProgram(composite("opaque.exr", "blind.glb", {"--camera", "eye=0,0,0;look=0,0,-1;fov=50"}), options).code, 0);
}

TEST_F(Errors, UnknownRequiredExtensionIsNamed) {
  GlbOptions options;
  options.extra = {{"extensionsRequired", {"ACME_imaginary"}}};
  writeGlb(folder + "/new.glb", {Quad{}}, options);
  before = filesIn(folder);
  EXPECT_NE(expectFailure(composite("opaque.exr", "new.glb"), 4).find("ACME_imaginary"), std::string::npos);
}

TEST_F(Errors, MissingTexture) {
  nlohmann::json material = unlit(1, 1, 1, 1);
  material["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", 0}};
  GlbOptions options;
  options.extra = {{"textures", {{{"source", 0}}}}, {"images", {{{"uri", "nowhere.png"}}}}};
  writeGlb(folder + "/textured.glb", {Quad{{-1, -1, -3}, {2, 0, 0}, {0, 2, 0}, material}}, options);
  before = filesIn(folder);
  EXPECT_NE(expectFailure(composite("opaque.exr", "textured.glb"), 3).find("nowhere.png"), std::string::npos);
}

TEST_F(Errors, Usage) {
  expectFailure({"composite", "opaque.exr"}, 2);
  expectFailure({"nonsense"}, 2);
  expectFailure(composite("opaque.exr", "glass.glb", {"--weight", "eq6"}), 2);
  expectFailure(composite("opaque.exr", "glass.glb", {"--weight", "power:-1"}), 2);
  expectFailure(composite("opaque.exr", "glass.glb", {"--weight-range", "5:1"}), 2);
  expectFailure(composite("opaque.exr", "glass.glb", {"--environment", "1,2"}), 2);
  expectFailure(composite("opaque.exr", "glass.glb", {"--order", "shuffle:x"}), 2);
  expectFailure(composite("opaque.exr", "glass.glb", {"--budget", "lots"}), 2);
  expectFailure(composite("opaque.exr", "glass.glb", {"--set", "nobody.thin=1"}), 2);
  expectFailure(composite("opaque.exr", "glass.glb", {"--frames", "1-3"}), 2);  // reserved, not parsed
  expectFailure(composite("opaque.exr", "glass.glb", {"--aa", "0"}), 2);
}

TEST_F(Errors, NoGlDevice) {
  RunOptions blind;
  blind.environment = {"__EGL_VENDOR_LIBRARY_FILENAMES=/nowhere"};
  EXPECT_NE(expectFailure(composite("opaque.exr", "glass.glb"), 6, blind).find("EGL"), std::string::npos);
  expectFailure(composite("opaque.exr", "glass.glb", {"--device", "99"}), 6);
}

TEST_F(Errors, FullDisk) {
  RunOptions full;
  full.maxFileBytes = 512;
  const std::string line = expectFailure(composite("opaque.exr", "glass.glb"), 6, full);
  EXPECT_NE(line.find("out.exr"), std::string::npos) << line;
  EXPECT_EQ(runProgram({"composite", folder + "/opaque.exr", folder + "/glass.glb", "--aa", "1", "-o",
                        folder + "/missing/out.exr"})
                .code,
            6);
}

// A report on a disk that is full: a sentence and an exit code, whether or not it is longer than what is kept before it
// is written.
TEST_F(Errors, ResultsThatCannotBePrintedAreTold) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no device that is full";
  std::vector<ExtraLayer> layers;
  for (int k = 0; k < 200; ++k)
    layers.push_back({"layer" + std::to_string(k), {{"R", Image<float>(4, 4, 0.0f)}, {"G", Image<float>(4, 4, 0.0f)}}});
  const Window window{0, 0, 4, 4};
  writeLayers(folder + "/many.exr", window, window, layers, {}, nullptr, false);
  const std::string program = "cd " + folder + " && " + PELLUCID_BINARY_DIR + "/bin/pellucid ";
  for (const std::string arguments : {"--version", "help methods", "composite --help", "compare opaque.exr opaque.exr",
                                      "compare many.exr many.exr --json"}) {
    const Ended ended = shell(program + arguments + " > /dev/full", folder);
    EXPECT_EQ(ended.code, 6) << arguments << ": " << ended.out;
    EXPECT_NE(ended.out.find("standard output: "), std::string::npos) << arguments << ": " << ended.out;
  }
  EXPECT_EQ(shell(program + "--version >&-", folder).code, 0) << "whoever closes it wants no results";
}

TEST_F(Errors, NumbersBeyondTheirEnds) {
  const auto said = [&](const std::vector<std::string>& flags) {
    std::vector<std::string> all{"composite", "none.exr", "none.glb", "-o", "out.exr"};
    all.insert(all.end(), flags.begin(), flags.end());
    return expectFailure(all, 2);
  };
  for (const char* value : {"0", "-2", "inf", "nan", "1e999", "x"})
    EXPECT_NE(said({std::string("--unit=") + value}).find("--unit: found"), std::string::npos) << value;
  EXPECT_NE(said({"--unit", "0"}).find("found 0, expected a number above 0"), std::string::npos);
  EXPECT_NE(said({"--tolerance", "-1"}).find("found -1, expected a number of 0 or more"), std::string::npos);
  // NaN is within no bounds; a gate that takes it would let everything pass.
  for (const char* flag : {"--tolerance", "--occlusion-direct", "--occlusion-radius", "--samples-adaptive"})
    EXPECT_NE(said({flag, "nan"}).find("found nan"), std::string::npos) << flag;
  for (const char* flag : {"--fail", "--failrelative", "--failpercent", "--hardfail", "--warn"})
    EXPECT_NE(expectFailure({"compare", "none.exr", "none.exr", flag, "nan"}, 2).find("found nan"), std::string::npos)
        << flag;
  // Squares of such places are beyond doubles.
  EXPECT_NE(said({"--camera", "eye=0,0,1e200;look=0,0,-1;fov=40"}).find("up to 1e+15"), std::string::npos);
}

TEST_F(Errors, OutputsAreRefusedBeforeAnythingIsRead) {
  // The inputs do not exist: whoever opened one would say so.
  for (const char* name : {"out.png", "out.jpg", "out", "out.exr.txt"}) {
    EXPECT_NE(expectFailure({"composite", "none.exr", "none.glb", "-o", name}, 2).find(name), std::string::npos);
    expectFailure({"gbuffer", "none.glb", "--size", "8x8", "-o", name}, 2);
    expectFailure({"accumulate", "none.exr", "none.glb", "-o", name}, 2);
    expectFailure({"fragments", "none.exr", "none.glb", "-o", name}, 2);
    expectFailure({"resolve", "none.exr", "none-planes.exr", "-o", name}, 2);
    expectFailure({"occlusion", "none.exr", "none-layer.exr", "-o", name}, 2);
    expectFailure({"flatten", "none.exr", "-o", name}, 2);
  }
  expectFailure({"study", "none.exr", "none.glb", "-o", "out.exr"}, 2);
  expectFailure({"compare", "none.exr", "none.exr", "--html", "out.exr"}, 2);
  EXPECT_NE(expectFailure({"composite", "none.exr", "none.glb", "-o", "nowhere/out.exr"}, 6).find("nowhere"),
            std::string::npos);
  EXPECT_NE(expectFailure({"composite", "out.exr", "none.glb", "-o", "./out.exr"}, 2).find("input"), std::string::npos);
  EXPECT_NE(expectFailure({"composite", "none.exr", "none.glb", "-o", "new.exr", "--shadows", "stochastic",
                           "--shadow-views", "new.exr"},
                          2)
                .find("--shadow-views"),
            std::string::npos);
}

TEST_F(Errors, LayerFlagsAreNamedAsTheVerbHasThem) {
  writeOpaque(folder + "/flat.exr", {.withDepth = false});
  writeOpaque(folder + "/two.exr", {.withSecondDepth = true});
  before = filesIn(folder);
  for (const char* layer : {"flat.exr", "two.exr"}) {
    const std::string line = expectFailure({"occlusion", "opaque.exr", layer, "-o", "out.exr"}, 4);
    EXPECT_NE(line.find("--layer-depth"), std::string::npos) << line;
    EXPECT_EQ(line.find("--depth"), std::string::npos) << line;
  }
}

TEST_F(Errors, InterruptedRunsLeaveTheOldFile) {
  for (const auto& [sent, code] : {std::pair{SIGINT, 130}, std::pair{SIGTERM, 143}}) {
    RunOptions options;
    options.interruptAfterMs = 700;
    options.signal = sent;
    std::vector<std::string> endless = composite("opaque.exr", "glass.glb");
    endless.back() = "4096";  // passes: far longer than the wait
    expectFailure(endless, code, options);
  }
}

TEST_F(Errors, PlanesThatDoNotMatch) {
  RunOptions options;
  options.folder = folder;
  const auto make = [&](const std::string& name, std::vector<std::string> more) {
    std::vector<std::string> arguments{"accumulate", "opaque.exr", "glass.glb", "-o", name};
    arguments.insert(arguments.end(), more.begin(), more.end());
    EXPECT_EQ(runProgram(arguments, options).code, 0);
  };
  make("a.exr", {});
  make("b.exr", {"--weight", "eq7z"});
  writeOpaque(folder + "/small.exr", {.width = 32, .height = 32});
  before = filesIn(folder);
  expectFailure({"resolve", "opaque.exr", "a.exr", "b.exr", "-o", "out.exr"}, 4);
  expectFailure({"resolve", "small.exr", "a.exr", "-o", "out.exr"}, 4);
  expectFailure({"resolve", "opaque.exr", "opaque.exr", "-o", "out.exr"}, 4);
  // Another camera: between planes, and beside a picture that states its own.
  make("moved.exr", {"--camera", "eye=0,0,0;look=0,0.1,-1;fov=50"});
  const Ended shot = runProgram({"gbuffer", "glass.glb", "-o", "shot.exr", "--size", "64x64"}, options);
  EXPECT_EQ(shot.code, 0) << shot.err;
  GlbOptions wide;
  wide.yfov = 1.2;
  writeGlb(folder + "/wide.glb", {Quad{{-1, -1, -3}, {2, 0, 0}, {0, 2, 0}, unlit(1, 0, 0, .5f)}}, wide);
  EXPECT_EQ(runProgram({"accumulate", "opaque.exr", "wide.glb", "-o", "wide.exr"}, options).code, 0);
  before = filesIn(folder);
  const std::string two = expectFailure({"resolve", "opaque.exr", "a.exr", "moved.exr", "-o", "out.exr"}, 4);
  EXPECT_NE(two.find("camera"), std::string::npos) << two;
  EXPECT_NE(two.find("a.exr"), std::string::npos) << two;
  EXPECT_NE(two.find("moved.exr"), std::string::npos) << two;
  const std::string other = expectFailure({"resolve", "shot.exr", "wide.exr", "-o", "out.exr"}, 4);
  EXPECT_NE(other.find("shot.exr"), std::string::npos) << other;
  EXPECT_NE(other.find("wide.exr"), std::string::npos) << other;
  // The same camera from glTF and from an attribute, and one that a flag put in its place when the planes were made.
  EXPECT_EQ(runProgram({"resolve", "shot.exr", "a.exr", "-o", "same.exr"}, options).code, 0);
  EXPECT_EQ(runProgram({"resolve", "shot.exr", "moved.exr", "-o", "given.exr"}, options).code, 0);
}

}  // namespace
}  // namespace pellucid
