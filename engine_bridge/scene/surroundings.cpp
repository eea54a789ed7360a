#include "engine_bridge/scene/surroundings.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <stdexcept>
#include <vector>

namespace pellucid {
namespace {

using namespace shading;  // NOLINT: the shared text's names

constexpr int kMostEdge = 1024;
// From this level on lobes are so wide that every texel is summed, over a source of this edge; before, they are
// sampled.
constexpr int kSummedFrom = 4, kSummedEdge = 64, kDiffuseEdge = 128;
constexpr int kTableSamples = 1024;

using Square = Image<glm::vec3>;

glm::vec3 directionAt(int x, int y, int edge) {
  return glm::normalize(directionOfOctahedron((glm::vec2(x, y) + 0.5f) / static_cast<float>(edge)));
}

// Solid angle of a texel, to the accuracy of its middle: d(omega) = dx dy / |p|^3 on each face of the octahedron.
float solidAngle(int x, int y, int edge) {
  const float length = glm::length(directionOfOctahedron((glm::vec2(x, y) + 0.5f) / static_cast<float>(edge)));
  const float step = 2.0f / static_cast<float>(edge);
  return step * step / (length * length * length);
}

glm::vec3 lookUp(const Square& square, glm::vec3 direction) {
  const int edge = square.width();
  const glm::vec2 at = octahedronOf(direction) * static_cast<float>(edge) - 0.5f;
  const glm::vec2 low = glm::floor(at), part = at - low;
  const glm::ivec2 first(low);
  const auto texel = [&](int x, int y) {
    const glm::ivec2 where = foldedTexel(first + glm::ivec2(x, y), edge);
    return square.at(where.x, where.y);
  };
  return (texel(0, 0) * (1.0f - part.x) + texel(1, 0) * part.x) * (1.0f - part.y) +
         (texel(0, 1) * (1.0f - part.x) + texel(1, 1) * part.x) * part.y;
}

glm::vec3 bilinear(const Image<glm::vec3>& map, glm::vec2 uv) {
  const int width = map.width(), height = map.height();
  const float x = uv.x * static_cast<float>(width) - 0.5f, y = uv.y * static_cast<float>(height) - 0.5f;
  const int left = static_cast<int>(std::floor(x)), top = static_cast<int>(std::floor(y));
  const float fx = x - std::floor(x), fy = y - std::floor(y);
  const auto texel = [&](int column, int row) {
    return map.at((column % width + width) % width, std::clamp(row, 0, height - 1));
  };
  return (texel(left, top) * (1.0f - fx) + texel(left + 1, top) * fx) * (1.0f - fy) +
         (texel(left, top + 1) * (1.0f - fx) + texel(left + 1, top + 1) * fx) * fy;
}

// Several samples a texel where the picture is finer.
Square toOctahedron(const Image<glm::vec3>& latLong, int edge) {
  Square square(edge, edge);
  const int steps = std::clamp(2 * latLong.width() / (2 * edge), 2, 16);
  tbb::parallel_for(0, edge, [&](int y) {
    for (int x = 0; x < edge; ++x) {
      glm::vec3 sum(0.0f);
      for (int j = 0; j < steps; ++j)
        for (int i = 0; i < steps; ++i) {
          const glm::vec2 inside = (glm::vec2(i, j) + 0.5f) / static_cast<float>(steps);
          const glm::vec2 at = (glm::vec2(x, y) + inside) / static_cast<float>(edge);
          sum += bilinear(latLong, latLongOf(glm::normalize(directionOfOctahedron(at))));
        }
      square.at(x, y) = sum / static_cast<float>(steps * steps);
    }
  });
  return square;
}

// Halves the edge; texels count by their solid angle.
Square halved(const Square& square) {
  const int edge = square.width() / 2;
  Square half(edge, edge);
  for (int y = 0; y < edge; ++y)
    for (int x = 0; x < edge; ++x) {
      glm::vec3 sum(0.0f);
      float weight = 0;
      for (int k = 0; k < 4; ++k) {
        const int fineX = 2 * x + k % 2, fineY = 2 * y + k / 2;
        const float own = solidAngle(fineX, fineY, 2 * edge);
        sum += own * square.at(fineX, fineY);
        weight += own;
      }
      half.at(x, y) = sum / weight;
    }
  return half;
}

// Levels of detail, the first the finest, the last of edge 1.
std::vector<Square> pyramidOf(Square square) {
  std::vector<Square> pyramid;
  pyramid.push_back(std::move(square));
  while (pyramid.back().width() > 1) pyramid.push_back(halved(pyramid.back()));
  return pyramid;
}

const Square& ofEdge(const std::vector<Square>& pyramid, int edge) {
  for (const Square& square : pyramid)
    if (square.width() <= edge) return square;
  return pyramid.back();
}

float alphaOf(float roughness) {
  const float held = std::max(roughness, PLD_MIN_ROUGHNESS);
  return held * held;
}

// Hammersley's points.
glm::vec2 pointOf(int i, int count) {
  std::uint32_t bits = static_cast<std::uint32_t>(i), turned = 0;
  for (int k = 0; k < 32; ++k, bits >>= 1) turned = turned << 1 | (bits & 1u);
  return {(static_cast<float>(i) + 0.5f) / static_cast<float>(count), static_cast<float>(turned) * 0x1p-32f};
}

// A microfacet's normal about +z with density D cos.
glm::vec3 facetOf(glm::vec2 u, float a2) {
  const float cosine = std::sqrt((1.0f - u.x) / (1.0f + (a2 - 1.0f) * u.x));
  const float sine = std::sqrt(std::max(1.0f - cosine * cosine, 0.0f)), angle = 2.0f * PLD_PI * u.y;
  return {sine * std::cos(angle), sine * std::sin(angle), cosine};
}

struct Axes {
  glm::vec3 s, t, n;
  explicit Axes(glm::vec3 normal) : n(normal) {
    s = glm::normalize(glm::cross(std::abs(n.x) < 0.9f ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0), n));
    t = glm::cross(n, s);
  }
  glm::vec3 from(glm::vec3 local) const { return s * local.x + t * local.y + n * local.z; }
};

// Sampled by the lobe, each sample read where the pyramid is as coarse as the sample is wide (Krivanek and Colbert,
// Real- time Shading with Filtered Importance Sampling, EGSR 2008).
glm::vec3 sampledLobe(const std::vector<Square>& pyramid, glm::vec3 axis, float a2, int samples) {
  const Axes axes(axis);
  const float texel = 4.0f * PLD_PI / static_cast<float>(pyramid[0].size());
  glm::vec3 sum(0.0f);
  float weight = 0;
  for (int i = 0; i < samples; ++i) {
    const glm::vec3 facet = facetOf(pointOf(i, samples), a2);
    const glm::vec3 local = 2.0f * facet.z * facet - glm::vec3(0, 0, 1);
    if (local.z <= 0.0f) continue;
    const float density = ggxDensity(facet.x * facet.x + facet.y * facet.y, a2) * 0.25f;
    const float detail = 0.5f * std::log2(2.0f / (static_cast<float>(samples) * density * texel));
    const float level = std::clamp(detail, 0.0f, static_cast<float>(pyramid.size() - 1));
    const auto fine = static_cast<std::size_t>(level);
    const std::size_t coarse = std::min(fine + 1, pyramid.size() - 1);
    const float between = level - static_cast<float>(fine);
    const glm::vec3 towards = axes.from(local);
    sum += local.z * (lookUp(pyramid[fine], towards) * (1.0f - between) + lookUp(pyramid[coarse], towards) * between);
    weight += local.z;
  }
  return sum / weight;
}

struct Texel {
  glm::vec3 direction, radiance;
  float angle;
};

std::vector<Texel> texelsOf(const Square& square) {
  std::vector<Texel> texels;
  const int edge = square.width();
  for (int y = 0; y < edge; ++y)
    for (int x = 0; x < edge; ++x) texels.push_back({directionAt(x, y, edge), square.at(x, y), solidAngle(x, y, edge)});
  return texels;
}

// Every texel by the lobe's density where eye, normal and axis are one; a2 < 0: by the cosine alone.
glm::vec3 summedLobe(const std::vector<Texel>& texels, glm::vec3 axis, float a2) {
  glm::vec3 sum(0.0f);
  float weight = 0;
  for (const Texel& texel : texels) {
    const float cosine = glm::dot(texel.direction, axis);
    if (cosine <= 0.0f) continue;
    // Half way between axis and direction.
    const float own = texel.angle * cosine * (a2 < 0.0f ? 1.0f : ggxDensity(0.5f * (1.0f - cosine), a2));
    sum += own * texel.radiance;
    weight += own;
  }
  return sum / weight;
}

// Column: cosine to the eye. x: reflected part of light from everywhere, Fresnel's term 1; y: the cosine at which a
// dielectric of index 1.5 has the mean Fresnel term.
glm::vec4 tableEntry(float cosine, float roughness) {
  const float a = alphaOf(roughness), a2 = a * a, c = std::max(cosine, 1e-3f);
  const glm::vec3 toEye(std::sqrt(1.0f - c * c), 0.0f, c);
  double all = 0, dielectric = 0;
  for (int i = 0; i < kTableSamples; ++i) {
    const glm::vec3 facet = facetOf(pointOf(i, kTableSamples), a2);
    const float cosHalf = glm::dot(toEye, facet);
    const glm::vec3 toLight = 2.0f * cosHalf * facet - toEye;
    if (toLight.z <= 0.0f || cosHalf <= 0.0f) continue;
    const float masked =
        toLight.z * std::sqrt(c * c * (1.0f - a2) + a2) + c * std::sqrt(toLight.z * toLight.z * (1.0f - a2) + a2);
    // f cos / density, Fresnel's term left out: the visibility of reflectTowardsEye.
    const double own = static_cast<double>(2.0f * toLight.z * cosHalf / (masked * facet.z));
    all += own;
    dielectric += own * static_cast<double>(fresnelDielectric(cosHalf, 1.5f));
  }
  if (!(all > 0.0)) return glm::vec4(0.0f, c, 0.0f, 0.0f);
  float low = 0.0f, high = 1.0f;  // the term falls as the cosine rises
  for (int i = 0; i < 24; ++i) {
    const float middle = 0.5f * (low + high);
    (static_cast<double>(fresnelDielectric(middle, 1.5f)) > dielectric / all ? low : high) = middle;
  }
  return glm::vec4(static_cast<float>(all / kTableSamples), 0.5f * (low + high), 0.0f, 0.0f);
}

}  // namespace

glm::vec4 Surroundings::at(const AtlasTaps& taps) const {
  const auto texel = [&](glm::ivec2 where) { return atlas.at(where.x, where.y); };
  return taps.weights.x * texel(taps.a) + taps.weights.y * texel(taps.b) + taps.weights.z * texel(taps.c) +
         taps.weights.w * texel(taps.d);
}

glm::vec3 Surroundings::reflected(const Surface& surface, glm::vec3 normal, glm::vec3 toEye, float cosEye) const {
  const GlossyLevels levels = glossyLevels(surface.roughness);
  const glm::vec3 mirrored = glossyDirection(normal, toEye, surface.roughness);
  const glm::vec3 first(at(directionTaps(mirrored, levels.first, edge)));
  const glm::vec3 second(at(directionTaps(mirrored, levels.second, edge)));
  const glm::vec3 diffuse(at(directionTaps(normal, PLD_DIFFUSE_LEVEL, edge)));
  return reflectEnvironment(surface, cosEye, diffuse, first + (second - first) * levels.between,
                            at(tableTaps(cosEye, surface.roughness, edge)));
}

Surroundings prepareSurroundings(const Image<glm::vec3>& latLong, int edge) {
  if (latLong.empty()) throw std::logic_error("surroundings without a picture");
  if (edge == 0)
    edge = static_cast<int>(
        std::bit_ceil(static_cast<unsigned>(std::clamp(latLong.width() / 2, PLD_LEAST_EDGE, kMostEdge))));
  const std::vector<Square> pyramid = pyramidOf(toOctahedron(latLong, edge));
  Surroundings result;
  result.edge = edge;
  result.atlas = Image<glm::vec4>(edge, levelRow(PLD_TABLE_LEVEL, edge) + PLD_LEAST_EDGE);
  const auto fill = [&](int level, auto&& value) {
    const int own = levelEdge(level, edge), row = levelRow(level, edge);
    tbb::parallel_for(0, own, [&](int y) {
      for (int x = 0; x < own; ++x) result.atlas.at(x, row + y) = value(x, y, own);
    });
  };
  for (int level = 0; level < PLD_GLOSSY_LEVELS; ++level) {
    const float a = alphaOf(static_cast<float>(level) / static_cast<float>(PLD_GLOSSY_LEVELS - 1));
    const std::vector<Texel> texels =
        level < kSummedFrom ? std::vector<Texel>{} : texelsOf(ofEdge(pyramid, kSummedEdge));
    fill(level, [&](int x, int y, int own) {
      if (level == 0) return glm::vec4(pyramid[0].at(x, y), 0.0f);
      const glm::vec3 axis = directionAt(x, y, own);
      return glm::vec4(
          level < kSummedFrom ? sampledLobe(pyramid, axis, a * a, 64 << level) : summedLobe(texels, axis, a * a), 0.0f);
    });
  }
  const std::vector<Texel> texels = texelsOf(ofEdge(pyramid, kDiffuseEdge));
  fill(PLD_DIFFUSE_LEVEL,
       [&](int x, int y, int own) { return glm::vec4(summedLobe(texels, directionAt(x, y, own), -1.0f), 0.0f); });
  fill(PLD_TABLE_LEVEL, [&](int x, int y, int own) {
    return tableEntry(static_cast<float>(x) / static_cast<float>(own - 1),
                      static_cast<float>(y) / static_cast<float>(own - 1));
  });
  return result;
}

}  // namespace pellucid
