#include "tests/campaign/order_trial.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>

#include "composite/denormals.h"
#include "composite/fold.h"
#include "composite/fold_exact.h"
#include "composite/resolve.h"

namespace pellucid::test {
namespace {

// The sums that lie in planes, then what is no sum.
constexpr std::size_t kSums = 6 * 4;
constexpr std::uint64_t kPictureEvery = 10, kProgressEvery = 100;  // turns of a part

std::vector<float> valuesOf(const OitPlanes& planes) {
  std::vector<float> values;
  values.reserve(planeValues(planes.frontZ.size()));
  const auto add = [&values](const Image<glm::vec4>& plane) {
    for (std::size_t i = 0; i < plane.size(); ++i)
      for (int c = 0; c < 4; ++c) values.push_back(plane[i][c]);
  };
  for (const Image<glm::vec4>* plane : {&planes.radiance, &planes.weight, &planes.opacity, &planes.depth, &planes.light,
                                        &planes.refraction, &planes.solid})
    add(*plane);
  for (const Image<float>* plane : {&planes.frontZ, &planes.diffuseZ})
    for (std::size_t i = 0; i < plane->size(); ++i) values.push_back((*plane)[i]);
  return values;
}

std::vector<float> valuesOf(const Picture& picture) {
  std::vector<float> values;
  for (std::size_t i = 0; i < picture.rgba.size(); ++i)
    for (int c = 0; c < 4; ++c) values.push_back(picture.rgba[i][c]);
  return values;
}

std::uint64_t digestOf(const std::vector<float>& values) {
  std::uint64_t hash = 0xcbf29ce484222325ull;  // FNV-1a, word by word
  for (const float value : values) {
    std::uint32_t bits;
    std::memcpy(&bits, &value, sizeof bits);
    hash = (hash ^ bits) * 0x100000001b3ull;
  }
  return hash;
}

OitPlanes drawn(TransparentPass& pass, const OrderShot& shot, Tier tier, const PassSettings& settings) {
  if (tier != Tier::exact) {
    PassSettings own = settings;
    if (tier == Tier::published) own.tier = SumsTier::published;
    return pass.accumulate(own);
  }
  OitPlanes planes = emptyPlanes(shot.gbuffer.display, shot.gbuffer.data);
  pass.fragments(
      settings, [&](const FragmentLists& lists) { foldExact(lists, settings.weight, settings.normalisation, planes); });
  return planes;
}

// Terms of one pixel in the order of its list, added in long double: nothing of the fold under test is used.
void addTerms(const FragmentLists& lists, std::size_t pixel, const glm::vec4& solid, const PassSettings& settings,
              bool published, long double (&sums)[kSums]) {
  long double passed[3] = {1, 1, 1};
  for (std::uint64_t i = lists.offsets[pixel]; i < lists.offsets[pixel + 1]; ++i) {
    const Fragment& fragment = lists.fragments[i];
    if (fragment.z > solid.a || shading::isSolid(fragment.coverage, fragment.transmission)) continue;
    const shading::Layer layer = layerFrom(fragment);
    if (published) {  // A; the product of what passes; s^2 and o delta, in pixels
      const shading::PublishedTargets t = shading::packPublished(layer, scatterFrom(fragment), settings.weight);
      for (int c = 0; c < 3; ++c) {
        sums[static_cast<std::size_t>(c)] += static_cast<long double>(t.radiance[c]);
        sums[static_cast<std::size_t>(4 + c)] += static_cast<long double>(t.radiance.a);
        passed[c] *= 1.0L - static_cast<long double>(t.beta[c]);
        sums[static_cast<std::size_t>(12 + c)] = passed[c];
      }
      const glm::vec2 offset = shading::PLD_SCATTER_UNIT * t.delta;
      sums[20] += static_cast<long double>(offset.x);
      sums[21] += static_cast<long double>(offset.y);
      sums[23] += static_cast<long double>(t.beta.a) * 63.0L * 63.0L;
      continue;
    }
    const shading::OitTargets t = shading::packSums(shading::layerSums(layer, settings.weight, settings.normalisation));
    const shading::ScatterTargets s = shading::packScatter(layer, scatterFrom(fragment));
    const glm::vec4 planes[] = {t.radiance, t.weight, t.opacity, t.depth, t.light, s.refraction};
    for (std::size_t k = 0; k < 6; ++k)
      for (int c = 0; c < 4; ++c) sums[k * 4 + static_cast<std::size_t>(c)] += static_cast<long double>(planes[k][c]);
    sums[4 * 4 + 3] += static_cast<long double>(s.refractionZ);
  }
}

void measureError(TransparentPass& pass, const OrderShot& shot, const OitPlanes& planes, OrderResult& result) {
  std::vector<double> errors;
  const Image<glm::vec4>* images[] = {&planes.radiance, &planes.weight, &planes.opacity,
                                      &planes.depth,    &planes.light,  &planes.refraction};
  const FlushDenormals flush;  // as every fold, and as llvmpipe
  pass.fragments(shot.settings, [&](const FragmentLists& lists) {
    for (int y = 0; y < lists.window.height(); ++y)
      for (int x = 0; x < lists.window.width(); ++x) {
        long double sums[kSums] = {};
        addTerms(lists, static_cast<std::size_t>(y * lists.window.width() + x), lists.solid.at(x, y), shot.settings,
                 planes.published(), sums);
        const int px = lists.window.x0 - planes.data.x0 + x, py = lists.window.y0 - planes.data.y0 + y;
        for (std::size_t k = 0; k < kSums; ++k) {
          if (sums[k] == 0.0L) continue;
          const Image<glm::vec4>& image = *images[k / 4];
          const auto c = static_cast<int>(k % 4);
          const long double found = image.empty() ? 0.0L : static_cast<long double>(image.at(px, py)[c]);
          errors.push_back(static_cast<double>(std::abs(found / sums[k] - 1.0L)));
        }
      }
  });
  if (errors.empty()) return;
  const auto at99 = errors.begin() + static_cast<std::ptrdiff_t>(errors.size() * 99 / 100);
  std::nth_element(errors.begin(), at99, errors.end());
  result.error99 = *at99;
  result.worstError = *std::max_element(at99, errors.end());
}

std::size_t geometryBytes(const Scene& scene) {
  std::size_t bytes = 0;
  for (const Primitive& primitive : scene.primitives)
    bytes += primitive.vertices.size() * sizeof(Vertex) + primitive.indices.size() * sizeof(std::uint32_t);
  return bytes;
}

PassSettings settingsOf(const OrderShot& shot, std::uint64_t turn) {
  PassSettings settings = shot.settings;
  const std::size_t bytes = geometryBytes(shot.scene);
  const std::size_t chunks[] = {bytes / 7, bytes / 3, 0};
  const int tiles[] = {0, 37, 64};
  settings.order.kind = turn == 1 ? SubmissionOrder::reverse : SubmissionOrder::shuffle;
  settings.order.seed = turn;
  settings.chunkBytes = chunks[turn % 3];
  settings.tile = tiles[turn / 3 % 3];
  return settings;
}

bool sameBits(float a, float b) {
  return std::memcmp(&a, &b, sizeof a) == 0;
}

}  // namespace

const char* nameOf(Tier tier) {
  return tier == Tier::exact ? "exact" : tier == Tier::floats ? "float" : "published";
}

OrderResult runOrderTrial(TransparentPass& pass, const OrderShot& shot, Tier tier, const TurnRange& turns,
                          const Marks& marks) {
  OrderResult result;
  const OitPlanes firstPlanes = drawn(pass, shot, tier, shot.settings);
  const std::vector<float> first = valuesOf(firstPlanes);
  ResolveSettings resolve;
  resolve.selfModulation = tier == Tier::published;
  const auto pictureOf = [&](const OitPlanes& planes) {
    return valuesOf(compose(resolveOver(planes, resolve, {}, shot.gbuffer), shot.gbuffer));
  };
  const std::vector<float> firstPicture = pictureOf(firstPlanes);
  result.digest = digestOf(first);
  result.values = first.size();
  result.pictureValues = firstPicture.size();
  measureError(pass, shot, firstPlanes, result);
  result.leastChunks = SIZE_MAX;
  for (std::uint64_t turn = turns.first; turn <= turns.last; turn += turns.step) {
    const OitPlanes planes = drawn(pass, shot, tier, settingsOf(shot, turn));
    const PassStatistics& statistics = pass.statistics();
    result.leastChunks = std::min<std::uint64_t>(result.leastChunks, statistics.chunks);
    result.mostChunks = std::max<std::uint64_t>(result.mostChunks, statistics.chunks);
    result.mostTiles = std::max<std::uint64_t>(result.mostTiles, statistics.tiles);
    ++result.turns;
    if (result.turns % kProgressEvery == 0)
      std::fprintf(stderr, "  %s: turn %llu\n", nameOf(tier), static_cast<unsigned long long>(turn));
    const std::vector<float> values = valuesOf(planes);
    bool changed = values.size() != first.size();
    for (std::size_t i = 0; i < std::min(values.size(), first.size()); ++i)
      if (!sameBits(values[i], first[i])) changed = true, marks.planes[i] = 1;
    if (values.size() != first.size()) std::fill(marks.planes, marks.planes + first.size(), std::uint8_t{1});
    // The picture is a function of the planes; it takes longer than they do.
    if (!changed || result.turns % kPictureEvery != 1) continue;
    const std::vector<float> picture = pictureOf(planes);
    for (std::size_t i = 0; i < picture.size(); ++i) {
      if (sameBits(picture[i], firstPicture[i])) continue;
      marks.picture[i] = 1;
      const double change = std::abs(static_cast<double>(picture[i]) - static_cast<double>(firstPicture[i]));
      result.worstPictureChange =
          std::max(result.worstPictureChange, change / std::max(1.0, std::abs(static_cast<double>(firstPicture[i]))));
    }
  }
  return result;
}

}  // namespace pellucid::test
