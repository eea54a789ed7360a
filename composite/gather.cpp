#include "composite/gather.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "composite/denormals.h"
#include "composite/wide_gaussian.h"
#include "composite/wide_pyramid.h"

namespace pellucid {

Backdrop backdropOf(const GBuffer& gbuffer, const Image<glm::vec4>& solid) {
  Backdrop backdrop{gbuffer.beauty, gbuffer.viewZ};
  for (std::size_t i = 0; i < solid.size(); ++i)
    if (std::isfinite(solid[i].a)) {
      backdrop.colour[i] = glm::vec4(glm::vec3(solid[i]), 1.0f);
      backdrop.z[i] = std::min(backdrop.z[i], solid[i].a);
    }
  return backdrop;
}

BackdropView PassBackdrop::of(const GBuffer& gbuffer, const Image<glm::vec4>& solid, glm::ivec2 place) {
  for (const std::size_t pixel : covered_) {
    own_.colour[pixel] = gbuffer.beauty[pixel];
    own_.z[pixel] = gbuffer.viewZ[pixel];
  }
  covered_.clear();
  const auto width = static_cast<std::size_t>(gbuffer.beauty.width());
  for (int y = 0; y < solid.height(); ++y)
    for (int x = 0; x < solid.width(); ++x)
      if (std::isfinite(solid.at(x, y).a))
        covered_.push_back(static_cast<std::size_t>(place.y + y) * width + static_cast<std::size_t>(place.x + x));
  if (covered_.empty()) return {gbuffer.beauty, gbuffer.viewZ};
  if (own_.z.empty()) own_ = {gbuffer.beauty, gbuffer.viewZ};
  for (const std::size_t pixel : covered_) {
    const glm::vec4& own =
        solid.at(static_cast<int>(pixel % width) - place.x, static_cast<int>(pixel / width) - place.y);
    own_.colour[pixel] = glm::vec4(glm::vec3(own), 1.0f);
    own_.z[pixel] = std::min(own_.z[pixel], own.a);
  }
  return own_;
}

EdgeTexels::EdgeTexels(std::vector<EdgeTexel> texels, int width, int height)
    : texels_(std::move(texels)),
      known_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), false),
      width_(width) {
  for (const EdgeTexel& texel : texels_)
    known_[static_cast<std::size_t>(texel.y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(texel.x)] =
        true;
}

const EdgeTexel& EdgeTexels::find(const glm::ivec2& pixel) const {
  return *std::lower_bound(texels_.begin(), texels_.end(), pixel,
                           [](const EdgeTexel& a, const glm::ivec2& b) { return a.y != b.y ? a.y < b.y : a.x < b.x; });
}

namespace {

struct Spreading {
  Window pixels;  // of the planes
  float most = 0.0f;
};

// Where the planes diffuse, and how much at most.
Spreading spreadingOf(const OitPlanes& planes) {
  const int width = planes.refraction.width(), height = planes.refraction.height();
  struct Row {
    int first = 0, end = 0;
    float most = 0.0f;
  };
  std::vector<Row> rows(static_cast<std::size_t>(height));
  tbb::parallel_for(0, height, [&](int y) {
    Row& row = rows[static_cast<std::size_t>(y)];
    row.first = width;
    for (int x = 0; x < width; ++x) {
      const float variance = planes.refraction.at(x, y).w;
      row.most = std::max(row.most, variance);
      if (!(variance > 0.0f)) continue;
      row.first = std::min(row.first, x);
      row.end = x + 1;
    }
  });
  Spreading all{{width, height, 0, 0}, 0.0f};
  for (int y = 0; y < height; ++y) {
    const Row& row = rows[static_cast<std::size_t>(y)];
    if (row.end == 0) continue;
    all.most = std::max(all.most, row.most);
    all.pixels = {std::min(all.pixels.x0, row.first), std::min(all.pixels.y0, y), std::max(all.pixels.x1, row.end),
                  y + 1};
  }
  return all.most > 0.0f ? all : Spreading{};
}

constexpr int kStrip = 16;  // columns that are filled together: what is read of a row of theirs lies side by side

// Calls work(x0, x1) for strips of the columns from x0 to x1, in parallel.
template <class Work>
void overStrips(int x0, int x1, const Work& work) {
  tbb::parallel_for(0, (x1 - x0 + kStrip - 1) / kStrip, [&](int strip) {
    const FlushDenormals flush;
    const int first = x0 + strip * kStrip;
    work(first, std::min(first + kStrip, x1));
  });
}

// The pixels that diffuse, for the lanes.
Columns tapsOf(shading::LookupText& text) {
  const Window& pixels = text.diffusing;
  Columns taps(pixels, shading::kTapPlanes, -1.0f);
  overStrips(pixels.x0, pixels.x1, [&](int x0, int x1) {
    for (int y = pixels.y0; y < pixels.y1; ++y)
      for (int x = x0; x < x1; ++x) {
        const glm::ivec2 pixel(x, y);
        const glm::vec4 colour = text.backdropColour(pixel);
        for (int k = 0; k < 4; ++k) *taps.at(shading::kTapColour + k, x, y) = colour[k];
        *taps.at(shading::kTapDepth, x, y) = text.backdropDepth(pixel);
        *taps.at(shading::kTapVariance, x, y) = text.isFiniteColour(colour) ? text.spreadAt(pixel) : -1.0f;
      }
  });
  return taps;
}

}  // namespace

namespace shading {

LookupText::LookupText(const BackdropView& seen, const OitPlanes& scattering, const LookupSettings& settings,
                       ivec2 place, const EdgeTexels* edgesOfPicture) {
  backdrop = seen;
  edges = edgesOfPicture && !edgesOfPicture->empty() ? edgesOfPicture : nullptr;
  planes = &scattering;
  placeOfPlanes = place;
  choice.kernel = settings.kernel;
  choice.exact = settings.exact ? 1 : 0;
  choice.largestSpread = std::hypot(static_cast<float>(width()), static_cast<float>(height()));
  choice.levels = 0;
  if (settings.kernel != PLD_DIFFUSE_GAUSSIAN) return;
  const Spreading spreading = spreadingOf(scattering);
  diffusing = {spreading.pixels.x0 + place.x, spreading.pixels.y0 + place.y, spreading.pixels.x1 + place.x,
               spreading.pixels.y1 + place.y};
  taps = tapsOf(*this);
  if (settings.exact) return;
  choice.levels = spreadLevel(kernelSpread(spreading.most, choice.largestSpread));
  for (int k = 1; k <= choice.levels; ++k) {
    SpreadLevel level(k, width(), height(), k == 1 ? diffusing : spreadLevels.back().holding);
    overStrips(level.holding.x0, level.holding.x1, [&](int x0, int x1) { wideHalved(*this, k, x0, x1, level); });
    level.repeat();
    tbb::parallel_for(0, level.blocks.width(), [&](int block) { level.summarise(block); });
    spreadLevels.push_back(std::move(level));
  }
}

}  // namespace shading

struct Lookups::Text : shading::LookupText {
  using LookupText::LookupText;
  struct Way {
    shading::Path path;
    glm::vec4 dispersion;
  };
  // Of a pixel of the planes.
  Way wayOf(int x, int y) const {
    const glm::vec4& refraction = planes->refraction.at(x, y);
    return {shading::pathOf(refraction, planes->refractionZAt(x, y), planes->diffuseZ.at(x, y)),
            planes->disperses() ? shading::dispersionOf(planes->dispersion.at(x, y), refraction.z) : glm::vec4(0.0f)};
  }
};

Lookups::Lookups(const BackdropView& backdrop, const OitPlanes& planes, const LookupSettings& settings,
                 glm::ivec2 place, const EdgeTexels* edges)
    : text_(new Text(backdrop, planes, settings, place, edges)) {}

Lookups::~Lookups() = default;

bool Lookups::scattersAt(int x, int y) const {
  const glm::vec4& refraction = text_->planes->refraction.at(x, y);
  return refraction.z > 0.0f || refraction.w > 0.0f;
}

bool Lookups::meetsEdges(int x, int y) const {
  if (!text_->edges) return false;
  const auto [path, dispersion] = text_->wayOf(x, y);
  const glm::ivec2 pixel = text_->placeOfPlanes + glm::ivec2(x, y);
  const glm::vec2 bends[] = {path.offset, path.offset + glm::vec2(dispersion.x, dispersion.y),
                             path.offset + glm::vec2(dispersion.z, dispersion.w)};
  bool meets = text_->edges->at(pixel);
  for (const glm::vec2& offset : bends)
    for (const glm::ivec2 beside : {glm::ivec2(-1, -1), glm::ivec2(0, -1), glm::ivec2(-1, 0), glm::ivec2(0, 0)}) {
      const glm::ivec2 at = glm::ivec2(glm::floor(glm::vec2(pixel) + 1.0f + offset)) + beside;
      meets = meets || text_->edges->at(glm::clamp(at, glm::ivec2(0), {text_->width() - 1, text_->height() - 1}));
    }
  return meets;
}

glm::vec4 Lookups::at(int x, int y) const {
  const auto [path, dispersion] = text_->wayOf(x, y);
  const glm::ivec2 pixel = text_->placeOfPlanes + glm::ivec2(x, y);
  return text_->lookupAt(text_->choice, path, dispersion, pixel, text_->ownColour(pixel));
}

}  // namespace pellucid
