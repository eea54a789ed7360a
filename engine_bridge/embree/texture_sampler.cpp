#include "engine_bridge/embree/texture_sampler.h"

#include <algorithm>
#include <cmath>

#include "shaders/mask.h"

namespace pellucid::rays {
namespace {

// GL 4.5, 8.14.2: coordinate in texels to an index.
int wrapped(float texel, int size, Wrap wrap) {
  const float count = static_cast<float>(size);
  switch (wrap) {
    case Wrap::repeat:
      texel -= count * std::floor(texel / count);
      break;
    case Wrap::mirror: {
      texel -= 2.0f * count * std::floor(texel / (2.0f * count));
      if (texel >= count) texel = 2.0f * count - 1.0f - texel;
      break;
    }
    case Wrap::clamp:
      break;
  }
  return static_cast<int>(std::clamp(texel, 0.0f, count - 1.0f));
}

}  // namespace

glm::vec4 sampleTexture(const Texture& texture, glm::vec2 uv, TexelFilter filter, TexelWeight weight) {
  const Image<glm::vec4>& texels = texture.texels;
  const int width = texels.width(), height = texels.height();
  const glm::vec2 at = uv * glm::vec2(static_cast<float>(width), static_cast<float>(height));
  if (texture.nearest || filter == TexelFilter::nearest)
    return texels.at(wrapped(std::floor(at.x), width, texture.wrapS), wrapped(std::floor(at.y), height, texture.wrapT));
  const float left = std::floor(at.x - 0.5f), top = std::floor(at.y - 0.5f);
  const float fx = at.x - 0.5f - left, fy = at.y - 0.5f - top;
  const int x0 = wrapped(left, width, texture.wrapS), x1 = wrapped(left + 1.0f, width, texture.wrapS);
  const int y0 = wrapped(top, height, texture.wrapT), y1 = wrapped(top + 1.0f, height, texture.wrapT);
  const auto stored = [&](int x, int y) {
    const glm::vec4 texel = texels.at(x, y);
    return weight == TexelWeight::plain ? texel : glm::vec4(glm::vec3(texel) * texel.a, texel.a);
  };
  const glm::vec4 upper = stored(x0, y0) * (1.0f - fx) + stored(x1, y0) * fx;
  const glm::vec4 lower = stored(x0, y1) * (1.0f - fx) + stored(x1, y1) * fx;
  const glm::vec4 filtered = upper * (1.0f - fy) + lower * fy;
  return weight == TexelWeight::plain ? filtered : shading::unweighted(filtered);
}

}  // namespace pellucid::rays
