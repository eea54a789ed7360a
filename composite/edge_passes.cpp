#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include "composite/edges.h"
#include "shaders/shading.h"

namespace pellucid {
namespace {

// Of an edge pixel in a veil; nothing where the veil ends before it.
std::optional<glm::ivec2> placeIn(const Veil& veil, const EdgePixel& pixel) {
  const int x = pixel.x - veil.place.x, y = pixel.y - veil.place.y;
  if (x < 0 || y < 0 || x >= veil.touched.width() || y >= veil.touched.height()) return std::nullopt;
  return glm::ivec2(x, y);
}

}  // namespace

EdgePasses::EdgePasses(std::vector<EdgePixel> pixels, std::vector<glm::dvec2> samples) : samples_(std::move(samples)) {
  const auto count = static_cast<int>(samples_.size());
  std::vector<int> order(samples_.size());
  std::vector<double> along(samples_.size());
  edges_.reserve(pixels.size());
  for (EdgePixel& pixel : pixels) {
    Edge edge;
    edge.nearerPasses = std::clamp(static_cast<int>(std::lround(pixel.share * count)), 1, count - 1);
    for (std::size_t i = 0; i < samples_.size(); ++i) along[i] = glm::dot(samples_[i], pixel.towardsNearer);
    std::iota(order.begin(), order.end(), 0);
    const auto precedes = [&](int a, int b) {
      const double one = along[static_cast<std::size_t>(a)], other = along[static_cast<std::size_t>(b)];
      return one != other ? one > other : a < b;
    };
    std::nth_element(order.begin(), order.begin() + (edge.nearerPasses - 1), order.end(), precedes);
    edge.seesNearer.assign(samples_.size(), false);
    for (int i = 0; i < edge.nearerPasses; ++i)
      edge.seesNearer[static_cast<std::size_t>(order[static_cast<std::size_t>(i)])] = true;
    transparentPicture_ = transparentPicture_ || pixel.alpha < 1.0f;
    edge.pixel = std::move(pixel);
    edges_.push_back(std::move(edge));
  }
}

namespace {

// What is nearer where it ends may lean so much that its plane goes on behind the farther. On its own side of the pixel
// the farther is hidden, and its plane tells nothing by lying in front.
double seenDepth(const EdgePixel& pixel, bool seesNearer, glm::dvec2 offset) {
  const double nearer = pixel.nearer.z(offset.x, offset.y), farther = pixel.farther.z(offset.x, offset.y);
  if (pixel.ridge) return std::max(nearer, farther);
  if (pixel.meet) return std::min(nearer, farther);
  const bool nearersSide = glm::dot(offset, pixel.towardsNearer) > 0.0;
  if (seesNearer) return nearersSide ? nearer : std::min(nearer, farther);
  return nearersSide ? std::max(nearer, farther) : farther;
}

}  // namespace

void EdgePasses::depthAt(int pass, Image<float>& viewZ) const {
  const auto number = static_cast<std::size_t>(pass);
  const glm::dvec2 offset = samples_[number] - 0.5;
  for (const Edge& edge : edges_) {
    const double z = seenDepth(edge.pixel, edge.seesNearer[number], offset);
    viewZ.at(edge.pixel.x, edge.pixel.y) = static_cast<float>(z);
  }
}

EdgeTexels EdgePasses::texelsOf(int pass, const Image<glm::vec4>& picture) const {
  std::vector<EdgeTexel> texels;
  texels.reserve(edges_.size());
  for (const auto& [pixel, nearerPasses, seesNearer] : edges_) {
    const glm::vec4& whole = picture.at(pixel.x, pixel.y);
    const auto share = static_cast<float>(pixel.share);
    const glm::vec3 nearer = glm::vec3(whole) * pixel.nearerPart / share,
                    farther = glm::vec3(whole) * (1.0f - pixel.nearerPart) / (1.0f - share);
    // What of the pixel's colour is a small share of it tells no colour; shadows dim both surfaces as they dim the
    // pixel.
    glm::vec3 alone = pixel.fartherAlone;
    for (int c = 0; c < 3; ++c)
      if (whole[c] != pixel.whole[c] && pixel.whole[c] > 0.0f) alone[c] *= whole[c] / pixel.whole[c];
    const bool sees = seesNearer[static_cast<std::size_t>(pass)];
    texels.push_back({pixel.x, pixel.y, whole,
                      sees ? glm::vec4(nearer, pixel.nearerAlpha) : glm::vec4(farther, pixel.fartherAlpha),
                      glm::vec4(alone, pixel.fartherAlpha), static_cast<float>(pixel.nearer.z(0.0, 0.0))});
  }
  return {std::move(texels), picture.width(), picture.height()};
}

EdgePasses::Part EdgePasses::partOf(const Edge& edge, int pass) const {
  const bool nearer = edge.seesNearer[static_cast<std::size_t>(pass)];
  const auto count = static_cast<float>(samples_.size());
  const float each =
      count / static_cast<float>(nearer ? edge.nearerPasses : static_cast<int>(samples_.size()) - edge.nearerPasses);
  const auto share = static_cast<float>(edge.pixel.share);
  Part part;
  part.light = each * (nearer ? share : 1.0f - share);
  part.transmission = each * (nearer ? edge.pixel.nearerPart : glm::vec3(1.0f) - edge.pixel.nearerPart);
  part.alpha = nearer ? edge.pixel.nearerAlpha : edge.pixel.fartherAlpha;
  return part;
}

void EdgePasses::weightAt(int pass, Image<float>& weight) const {
  for (const Edge& edge : edges_) weight.at(edge.pixel.x, edge.pixel.y) = partOf(edge, pass).light;
}

void EdgePasses::weigh(int pass, Veil& veil) const {
  if (transparentPicture_) veil.addScatter();
  for (const Edge& edge : edges_) {
    const std::optional<glm::ivec2> at = placeIn(veil, edge.pixel);
    if (!at) continue;
    const Part part = partOf(edge, pass);
    veil.light.at(at->x, at->y) *= part.light;
    veil.transmission.at(at->x, at->y) *= part.transmission;
    if (!veil.scatters()) continue;
    glm::vec3& direct = veil.direct.at(at->x, at->y);
    const float passed = shading::meanOf(direct);
    direct *= part.transmission;
    glm::vec4& applied = veil.applied.at(at->x, at->y);
    applied *= part.light;
    // compose() lets nothing shine by the pixel's own alpha; here it is that of the surface.
    applied.a += part.light * passed * (1.0f - part.alpha) - shading::meanOf(direct) * (1.0f - edge.pixel.alpha);
  }
}

void EdgePasses::finish(Veil& mean) const {
  for (const Edge& edge : edges_) {
    const std::optional<glm::ivec2> at = placeIn(mean, edge.pixel);
    if (!at) continue;
    glm::vec3& transmission = mean.transmission.at(at->x, at->y);
    transmission = mean.touched.at(at->x, at->y) ? glm::min(transmission, glm::vec3(1.0f)) : glm::vec3(1.0f);
  }
}

}  // namespace pellucid
