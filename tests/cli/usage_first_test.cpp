// What is wrong with a command line is told before any file is opened, so also where the files do not exist.
#include <gtest/gtest.h>

#include "tests/support/program.h"

namespace pellucid {
namespace {

using namespace test;

struct Line {
  std::vector<std::string> verb, flags;
  std::string flag;  // that the sentence names
};

TEST(UsageFirst, IsToldWithoutTheFiles) {
  const std::vector<std::string> composite{"composite", "none.exr", "none.glb"},
      accumulate{"accumulate", "none.exr", "none.glb"}, gbuffer{"gbuffer", "none.glb", "--size", "8x8"},
      render{"render", "none.glb", "--size", "8x8"};
  const std::vector<Line> lines{
      {composite, {"--set", "glass"}, "--set"},
      {composite, {"--set", "glass.colour=1"}, "--set"},
      {composite, {"--set", "glass.thin=perhaps"}, "--set"},
      {composite, {"--set", "glass.collimation=1.5"}, "--set"},
      {composite, {"--far", "-1"}, "--far"},
      {accumulate, {"--set", "glass.thin=perhaps"}, "--set"},
      {render, {"--set", "glass.thin=perhaps"}, "--set"},
      {gbuffer, {"--set", "glass.colour=1"}, "--set"},
      {gbuffer, {"--renderer", "gl", "--samples", "4"}, "--samples"},
      {gbuffer, {"--renderer", "gl", "--ao-radius", "1"}, "--ao-radius"},
      {gbuffer, {"--renderer", "gl", "--shadows", "exact"}, "--shadows"},
      {gbuffer, {"--renderer", "gl", "--environment", "sky.exr"}, "--environment"},
      {gbuffer, {"--renderer", "embree", "--texture-filter", "mipmap"}, "--texture-filter"},
      {gbuffer, {"--renderer", "embree", "--device", "0"}, "--device"},
      {gbuffer, {"--shutter", "0:1"}, "--shutter"},
      {gbuffer, {"--lens-radius", "0.1"}, "--focus"},
      {gbuffer, {"--aa", "4"}, "--aa"},
      {composite, {"--frames", ""}, "--frames"},
      {composite, {"--frame", ""}, "--frame"},
      {composite, {"--fog", ""}, "--fog"},
      {composite, {"--environment="}, "--environment"},
      {accumulate, {"--camera", ""}, "--camera"},
      {accumulate, {"--focus", ""}, "--focus"},
      {render, {"--ocio", ""}, "--ocio"},
  };
  for (const Line& line : lines) {
    std::vector<std::string> arguments = line.verb;
    arguments.insert(arguments.end(), {"-o", "out.exr"});
    arguments.insert(arguments.end(), line.flags.begin(), line.flags.end());
    RunOptions options;
    options.folder = freshFolder("usage-first");
    const Ended ended = runProgram(arguments, options);
    EXPECT_EQ(ended.code, 2) << line.verb[0] << " " << line.flags[0] << ": " << ended.err;
    EXPECT_NE(ended.err.find(line.flag), std::string::npos) << ended.err;
  }
}

}  // namespace
}  // namespace pellucid
