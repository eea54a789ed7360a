// Opaque EXRs that tests write for themselves.
#pragma once
#include <string>

#include "gbuffer/opaque_io.h"

namespace pellucid::test {

struct OpaqueShot {
  int width = 64, height = 64;
  glm::vec4 colour{0.25f, 0.5f, 0.75f, 1.0f};
  float depth = 10.0f;
  bool half = false;
  bool withDepth = true, withSecondDepth = false;
};

inline void writeOpaque(const std::string& path, const OpaqueShot& shot = {}) {
  const auto plane = [&](float value) { return Image<float>(shot.width, shot.height, value); };
  ExtraLayer beauty{"",
                    {{"R", plane(shot.colour.r)},
                     {"G", plane(shot.colour.g)},
                     {"B", plane(shot.colour.b)},
                     {"A", plane(shot.colour.a)}}};
  if (shot.withDepth) beauty.channels.emplace_back("Z", plane(shot.depth));
  std::vector<ExtraLayer> layers{beauty};
  if (shot.withSecondDepth) layers.push_back({"depth", {{"Z", plane(shot.depth)}}});
  const Window window{0, 0, shot.width, shot.height};
  writeLayers(path, window, window, layers, {}, nullptr, shot.half);
}

}  // namespace pellucid::test
