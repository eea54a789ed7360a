#include "composite/gather.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "composite/denormals.h"
#include "composite/spread_pyramid.h"

namespace pellucid {
namespace shading {

// The shared text of the lookup, with the functions by which it reads the picture.
struct LookupText {
  const Backdrop& backdrop;
  const OitPlanes& planes;
  std::vector<SpreadLevel> levels = {};  // [0] is level 1

  template <class T>
  static const T& clampedAt(const Image<T>& image, ivec2 place) {
    return image.at(std::clamp(place.x, 0, image.width() - 1), std::clamp(place.y, 0, image.height() - 1));
  }
  const vec4& backdropColour(ivec2 pixel) const { return clampedAt(backdrop.colour, pixel); }
  float backdropDepth(ivec2 pixel) const { return clampedAt(backdrop.z, pixel); }
  float spreadAt(ivec2 pixel) const { return clampedAt(planes.refraction, pixel).w; }
  const SpreadTexel& spreadTexel(int level, ivec2 texel) const {
    return levels[static_cast<std::size_t>(level - 1)].clamped(texel);
  }
  const SpreadBody& spreadBody(int level, ivec2 texel) const { return spreadTexel(level, texel).body; }

#define PLD_FN inline
#define precise
#include "shaders/shared/gather.glsl"
#undef precise
#undef PLD_FN
};

}  // namespace shading

Backdrop backdropOf(const GBuffer& gbuffer, const Image<glm::vec4>& solid) {
  Backdrop backdrop{gbuffer.beauty, gbuffer.viewZ};
  for (std::size_t i = 0; i < solid.size(); ++i)
    if (std::isfinite(solid[i].a)) {
      backdrop.colour[i] = glm::vec4(glm::vec3(solid[i]), 1.0f);
      backdrop.z[i] = std::min(backdrop.z[i], solid[i].a);
    }
  return backdrop;
}

struct Lookups::Text : shading::LookupText {
  shading::LookupText::LookupChoice choice = {};
};

Lookups::Lookups(const Backdrop& backdrop, const OitPlanes& planes, const LookupSettings& settings)
    : text_(new Text{{backdrop, planes}}) {
  const int width = planes.data.width(), height = planes.data.height();
  shading::LookupText::LookupChoice& choice = text_->choice;
  choice.kernel = settings.kernel;
  choice.exact = settings.exact ? 1 : 0;
  choice.largestSpread = std::hypot(static_cast<float>(width), static_cast<float>(height));
  choice.levels = 0;
  if (settings.kernel != shading::PLD_DIFFUSE_GAUSSIAN || settings.exact) return;
  float most = 0.0f;
  for (std::size_t i = 0; i < planes.refraction.size(); ++i) most = std::max(most, planes.refraction[i].w);
  choice.levels = shading::spreadLevel(shading::kernelSpread(most, choice.largestSpread));
  for (int k = 1; k <= choice.levels; ++k) {
    SpreadLevel level((width + (1 << k) - 1) >> k, (height + (1 << k) - 1) >> k);
    tbb::parallel_for(tbb::blocked_range<int>(0, level.texels.height()), [&](const tbb::blocked_range<int>& rows) {
      const FlushDenormals flush;
      for (int y = rows.begin(); y != rows.end(); ++y)
        for (int x = 0; x < level.texels.width(); ++x)
          level.texels.at(x, y) =
              text_->halvedTexel(k, glm::ivec2(x - shading::PLD_SPREAD_MARGIN, y - shading::PLD_SPREAD_MARGIN));
    });
    text_->levels.push_back(std::move(level));
  }
}

Lookups::~Lookups() = default;

bool Lookups::scattersAt(int x, int y) const {
  const glm::vec4& refraction = text_->planes.refraction.at(x, y);
  return refraction.z > 0.0f || refraction.w > 0.0f;
}

glm::vec4 Lookups::at(int x, int y) const {
  const OitPlanes& planes = text_->planes;
  const glm::vec4& refraction = planes.refraction.at(x, y);
  const shading::Path path = shading::pathOf(refraction, planes.light.at(x, y).a, planes.diffuseZ.at(x, y));
  const glm::vec4 dispersion =
      planes.disperses() ? shading::dispersionOf(planes.dispersion.at(x, y), refraction.z) : glm::vec4(0.0f);
  return text_->lookupAt(text_->choice, path, dispersion, glm::ivec2(x, y));
}

}  // namespace pellucid
