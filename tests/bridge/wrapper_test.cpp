// pellucid.hpp: what C++ hosts hold.
#include "engine_bridge/include/pellucid/pellucid.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <utility>

#include "tests/bridge/host.h"
#include "tests/support/program.h"
#include "tests/support/shell.h"

namespace pellucid::test {
namespace {

static_assert(!std::is_copy_constructible_v<pld::Pass> && std::is_nothrow_move_constructible_v<pld::Pass>);

// The host's info by way of pld_create_info_init().
pld_create_info infoOf(const Host& host) {
  const pld_create_info whole = host.info();
  pld_create_info info = pld_create_info_init();
  info.get_proc_address = whole.get_proc_address;
  info.depth = whole.depth;
  info.rows = whole.rows;
  return info;
}

pld_frame frameOf(const Host& host) {
  const pld_frame whole = host.frame();
  pld_frame frame = pld_frame_init();
  frame.colour_texture = whole.colour_texture;
  frame.depth_texture = whole.depth_texture;
  frame.width = whole.width;
  frame.height = whole.height;
  std::copy(std::begin(whole.projection), std::end(whole.projection), frame.projection);
  return frame;
}

TEST(BridgeWrapper, AFrameIsDrawnFromInitialisedStructs) {
  GlContext context;
  Host host(24, 16);
  pld::Pass pass(infoOf(host));
  pass.resize(24, 16);
  int drawn = 0;
  pass.stage(PLD_STAGE_LAYERS, frameOf(host), [&] { ++drawn; });
  pass.resolve(pld_target_init(PLD_TARGET_TEXTURE, host.output));
  EXPECT_EQ(drawn, 1);
  EXPECT_EQ(pass.query(PLD_VALUE_GEOMETRY_PASSES), 1u);
  pld::Pass other(std::move(pass));
  EXPECT_TRUE(other);
  EXPECT_FALSE(pass);  // NOLINT: what it is after the move is the matter
}

TEST(BridgeWrapper, WhatLayersTellGoesIntoTextures) {
  GlContext context;
  Host host(24, 16);
  pld_create_info info = infoOf(host);
  info.features = PLD_FEATURE_DEPTHS;
  pld::Pass pass(info);
  pass.resize(24, 16);
  pass.stage(PLD_STAGE_LAYERS, frameOf(host), [] {});
  pass.resolve(PLD_VIEW_MEAN_DEPTH, host.output);
  EXPECT_TRUE(std::isinf(host.picture()[0]));
  try {
    pass.resolve(PLD_VIEW_MOTION, host.output);
    ADD_FAILURE() << "motion was not asked for";
  } catch (const pld::Error& error) {
    EXPECT_EQ(error.status(), PLD_ERROR_UNSUPPORTED);
  }
}

TEST(BridgeWrapper, WhatFailsIsThrownWithItsSentence) {
  GlContext context;
  Host host(24, 16);
  pld_create_info info = infoOf(host);
  info.tier = static_cast<pld_tier>(77);
  try {
    const pld::Pass pass(info);
    ADD_FAILURE() << "a tier that there is not";
  } catch (const pld::Error& error) {
    EXPECT_EQ(error.status(), PLD_ERROR_ARGUMENT);
    EXPECT_NE(std::string(error.what()).find("tier"), std::string::npos) << error.what();
  }
  pld::Pass pass(infoOf(host));
  EXPECT_THROW(pass.stage(PLD_STAGE_LAYERS, frameOf(host), [] {}), pld::Error) << "before resize";
}

// The stage is ended all the same, and the next frame begins as if nothing had been.
TEST(BridgeWrapper, AnExceptionOfTheHostsEndsTheStage) {
  GlContext context;
  Host host(24, 16);
  pld::Pass pass(infoOf(host));
  pass.resize(24, 16);
  const pld_frame frame = frameOf(host);
  EXPECT_THROW(pass.stage(PLD_STAGE_LAYERS, frame, [] { throw std::runtime_error("the host's"); }), std::runtime_error);
  EXPECT_NO_THROW(pass.stage(PLD_STAGE_LAYERS, frame, [] {}));
}

TEST(BridgeWrapper, HeadersCompileAsTheOldestLanguagesTheyAreFor) {
  const std::string folder = freshFolder("bridge-wrapper");
  const std::string flags =
      " -Wall -Wextra -Wpedantic -Werror -fsyntax-only -I'" PELLUCID_SOURCE_DIR "/engine_bridge/include' -x ";
  for (const char* compiler :
       {"c++ -std=c++11 -include pellucid/pellucid.hpp", "cc -std=c99 -include pellucid/pellucid.h"}) {
    const bool plain = std::string(compiler).rfind("cc ", 0) == 0;
    const Ended ended =
        shell("echo 'int main(void) { return 0; }' | " + std::string(compiler) + flags + (plain ? "c" : "c++") + " -",
              folder);
    EXPECT_EQ(ended.code, 0) << ended.out;
  }
}

}  // namespace
}  // namespace pellucid::test
