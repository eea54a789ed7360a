#include "composite/deep/deep_opaque.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "composite/deep/tidy.h"
#include "gbuffer/deep_io.h"
#include "shaders/shading.h"

namespace pellucid {
namespace {

constexpr std::uint64_t kMostAtOnce = std::uint64_t{1} << 21;
// What floats leave of a pixel that is covered.
constexpr double kCovered = 1e-6;
constexpr float kNothing = std::numeric_limits<float>::infinity();

bool bends(const Fragment& fragment) {
  return fragment.variance > 0.0f || fragment.offset != glm::vec2(0.0f);
}

}  // namespace

DeepOpaque readDeepOpaque(const std::string& path, const DeepChannels& channels, const DepthConverter& depth) {
  DeepReader reader(path, channels.part, channels.names);
  DeepOpaque opaque;
  opaque.display = reader.display();
  opaque.data = reader.data();
  const int width = opaque.data.width(), height = opaque.data.height();
  opaque.flat = Image<glm::vec4>(width, height, glm::vec4(0.0f));
  opaque.farthest = Image<float>(width, height, kNothing);
  opaque.offsets.assign(1, 0);
  std::vector<DeepSample> pixel;
  DeepRows rows;
  for (int y = opaque.data.y0; y < opaque.data.y1;) {
    rows = reader.read(y, opaque.data.y1, kMostAtOnce, std::move(rows));
    for (std::size_t i = 0; i + 1 < rows.offsets.size(); ++i) {
      const int px = opaque.data.x0 + static_cast<int>(i) % width, py = rows.window.y0 + static_cast<int>(i) / width;
      pixel.clear();
      for (std::uint64_t k = rows.offsets[i]; k < rows.offsets[i + 1]; ++k) {
        DeepSample sample;
        opaque.stored.add(static_cast<double>(rows.channels[static_cast<std::size_t>(channels.z)][k]));
        if (sampleAt(channels, rows, k, depth, px, py, sample, opaque.oddities) && sample.z > 0.0)
          pixel.push_back(sample);
      }
      glm::dvec4 left(1.0);
      glm::dvec3 light(0.0);
      float farthest = 0.0f;
      visitTidy(pixel, {}, [&](const DeepSample& piece) {
        const glm::dvec3 share = glm::dvec3(left) * glm::dvec3(piece.opacity), seen = glm::dvec3(left) * piece.light;
        light += seen;
        left *= glm::dvec4(1.0) - piece.opacity;
        farthest = static_cast<float>(piece.zBack);
        opaque.samples.push_back({static_cast<float>(0.5 * (piece.z + piece.zBack)), glm::vec3(share), glm::vec3(seen),
                                  static_cast<float>(0.5 * (piece.zBack - piece.z))});
      });
      const std::size_t at = opaque.offsets.size() - 1;
      opaque.offsets.push_back(opaque.samples.size());
      opaque.flat[at] = glm::vec4(glm::vec3(light), static_cast<float>(1.0 - left.w));
      if (std::max({left.x, left.y, left.z}) <= kCovered)
        opaque.farthest[at] = static_cast<double>(farthest) < kFarthest ? farthest : kNothing;
    }
    y = rows.window.y1;
  }
  return opaque;
}

namespace {

// The entries of a row in the making.
class RowOfEntries {
 public:
  RowOfEntries(const FragmentLists& lists, const DeepOpaque& opaque, bool cut)
      : lists_(lists), opaque_(opaque), cut_(cut) {
    held_.lists.offsets.assign(1, 0);
    held_.first.assign(1, 0);
  }

  //   own    the pixel's number in the picture
  //   empty  it has no entry
  void addPixel(std::size_t pixel, glm::ivec2 at, std::size_t own, bool empty) {
    pixel_ = pixel;
    at_ = at;
    glm::dvec3 rest(1.0);
    for (std::uint64_t k = opaque_.offsets[own]; !empty && k < opaque_.offsets[own + 1]; ++k) {
      const OpaqueSample& sample = opaque_.samples[k];
      if (!cut_ || !addParts(sample, rest)) add(sample.z, reachOf(sample.z), k + own, glm::dvec3(1.0), false);
      rest -= glm::dvec3(sample.share);
    }
    if (!empty) add(kNothing, kNothing, opaque_.offsets[own + 1] + own, glm::dvec3(1.0), false);
    held_.first.push_back(held_.z.size());
  }

  HeldOutRow finish() {
    FragmentLists& row = held_.lists;
    row.window = {0, 0, static_cast<int>(solids_.size()), 1};
    row.solid = Image<glm::vec4>(row.window.width(), 1);
    std::copy(solids_.begin(), solids_.end(), row.solid.data());
    return std::move(held_);
  }

 private:
  float reachOf(float z) const { return z * (1.0f + opaque_.depthPrecision); }

  //   z      depth of the sample
  //   reach  up to which layers are in front of it
  void add(float z, float reach, std::size_t place, glm::dvec3 part, bool goesOn) {
    FragmentLists& row = held_.lists;
    bool bent = false;
    for (std::uint64_t i = lists_.offsets[pixel_]; i < lists_.offsets[pixel_ + 1]; ++i) {
      if (lists_.fragments[i].z > reach) continue;
      row.append(lists_, i, i + 1);
      bent = bent || bends(lists_.fragments[i]);
    }
    const glm::vec4 solid = lists_.solid[pixel_];
    solids_.push_back(solid.a <= reach ? solid : glm::vec4(0.0f, 0.0f, 0.0f, kNothing));
    row.endPixel();
    held_.pixel.push_back(at_);
    held_.z.push_back(z);
    held_.place.push_back(place);
    held_.bends.push_back(bent);
    if (!cut_) return;
    held_.part.emplace_back(part);
    held_.goesOn.push_back(goesOn);
  }

  // The parts of a volume between the layers inside of it; false where there are none.
  bool addParts(const OpaqueSample& sample, glm::dvec3 rest) {
    if (!(sample.reach > 0.0f)) return false;
    const float front = sample.z - sample.reach, back = sample.z + sample.reach;
    cuts_.clear();
    const auto cutAt = [&](float z) {
      if (z > front && z < back) cuts_.push_back(z);
    };
    for (std::uint64_t i = lists_.offsets[pixel_]; i < lists_.offsets[pixel_ + 1]; ++i) cutAt(lists_.fragments[i].z);
    cutAt(lists_.solid[pixel_].a);
    if (cuts_.empty()) return false;
    std::sort(cuts_.begin(), cuts_.end());
    cuts_.erase(std::unique(cuts_.begin(), cuts_.end()), cuts_.end());
    cuts_.push_back(back);
    float from = front;
    for (const float to : cuts_) {
      const double begin = lengthTo(from, sample), end = lengthTo(to, sample);
      add(0.5f * (from + to), from, HeldOutRow::kNoPlace, partBetween(sample, rest, begin, end), from > front);
      from = to;
    }
    return true;
  }
  static double lengthTo(float z, const OpaqueSample& sample) {
    const double reach = static_cast<double>(sample.reach), middle = static_cast<double>(sample.z);
    return std::clamp(0.5 + 0.5 * (static_cast<double>(z) - middle) / reach, 0.0, 1.0);
  }
  // As partOfVolume() has it: of opacity o, a length x from the front hides 1 - (1 - o)^x, and light scales with that.
  static glm::dvec3 partBetween(const OpaqueSample& sample, glm::dvec3 rest, double begin, double end) {
    glm::dvec3 part(end - begin);
    for (int c = 0; c < 3; ++c) {
      const double share = static_cast<double>(sample.share[c]);
      const double opacity = rest[c] > 0.0 ? std::min(share / rest[c], 1.0) : 1.0;
      const double depth = std::log1p(-opacity);
      if (opacity >= 1.0)
        part[c] = begin > 0.0 ? 0.0 : 1.0;
      else if (opacity > 0.0)
        part[c] = (std::expm1(begin * depth) - std::expm1(end * depth)) / opacity;
    }
    return part;
  }

  const FragmentLists& lists_;
  const DeepOpaque& opaque_;
  const bool cut_;
  HeldOutRow held_;
  std::vector<glm::vec4> solids_;
  std::vector<float> cuts_;
  std::size_t pixel_ = 0;  // of the lists
  glm::ivec2 at_{0, 0};
};

}  // namespace

HeldOutRow holdOut(const FragmentLists& lists, const DeepOpaque& opaque, bool everywhere, VolumeCuts cuts) {
  RowOfEntries row(lists, opaque, cuts == VolumeCuts::atLayers);
  const int left = lists.window.x0 - opaque.data.x0, top = lists.window.y0 - opaque.data.y0;
  std::size_t pixel = 0;
  for (int y = 0; y < lists.window.height(); ++y)
    for (int x = 0; x < lists.window.width(); ++x, ++pixel) {
      const std::size_t own = static_cast<std::size_t>(top + y) * static_cast<std::size_t>(opaque.data.width()) +
                              static_cast<std::size_t>(left + x);
      const bool any =
          lists.offsets[pixel] != lists.offsets[pixel + 1] || std::isfinite(lists.solid[pixel].a) || everywhere;
      row.addPixel(pixel, {lists.window.x0 + x, lists.window.y0 + y}, own, !any);
    }
  return row.finish();
}

std::size_t placesOf(const DeepOpaque& opaque) {
  return opaque.samples.size() + opaque.offsets.size() - 1;
}

glm::vec3 sumOfPlaces(const DeepOpaque& opaque, std::size_t pixel, const Image<glm::vec3>& places) {
  glm::dvec3 rest(1.0), sum(0.0);
  for (std::uint64_t k = opaque.offsets[pixel]; k < opaque.offsets[pixel + 1]; ++k) {
    const glm::dvec3 share(opaque.samples[k].share);
    rest -= share;
    sum += share * glm::dvec3(places[k + pixel]);
  }
  sum += glm::max(rest, glm::dvec3(0.0)) * glm::dvec3(places[opaque.offsets[pixel + 1] + pixel]);
  return glm::vec3(sum);
}

void addHeldOut(const Window& window, const HeldOutRow& heldOut, const Veil& row, const DeepOpaque& opaque,
                const OitPlanes* scatter, Veil& veil, Image<glm::vec3>& lookedUp) {
  const int left = window.x0 - opaque.data.x0, top = window.y0 - opaque.data.y0;
  std::size_t pixel = 0;
  for (int y = 0; y < window.height(); ++y)
    for (int x = 0; x < window.width(); ++x, ++pixel) {
      if (heldOut.first[pixel] == heldOut.first[pixel + 1]) continue;
      const int px = left + x, py = top + y;
      const std::size_t own =
          static_cast<std::size_t>(py) * static_cast<std::size_t>(opaque.data.width()) + static_cast<std::size_t>(px);
      const bool looksElsewhere = scatter && scattersAt(*scatter, px, py);
      glm::dvec3 rest(1.0), light(0.0), behind(0.0), transmission(0.0), elsewhere(0.0);
      float front = kNothing;
      bool touched = false;
      float open = 0.0f;
      std::size_t entry = heldOut.first[pixel];
      for (std::uint64_t k = opaque.offsets[own]; k <= opaque.offsets[own + 1]; ++k) {
        const bool beyond = k == opaque.offsets[own + 1];
        const glm::dvec3 whole = beyond ? glm::max(rest, glm::dvec3(0.0)) : glm::dvec3(opaque.samples[k].share);
        rest -= whole;
        do {
          const glm::dvec3 part = heldOut.partOf(entry), share = part * whole;
          const bool covered = row.touched[entry] && std::max({share.x, share.y, share.z}) > (beyond ? kCovered : 0.0);
          const glm::dvec3 passed = row.touched[entry] ? glm::dvec3(row.transmission[entry]) : glm::dvec3(1.0);
          if (row.touched[entry]) light += share * glm::dvec3(row.light[entry]);
          transmission += share * passed;
          if (covered) {
            touched = true;
            front = std::min(front, row.frontZ[entry]);
          }
          if (covered && looksElsewhere && heldOut.bends[entry])
            elsewhere += share * passed;
          else if (beyond)
            open = shading::meanOf(glm::vec3(share * passed));
          else
            behind += passed * part * glm::dvec3(opaque.samples[k].light);
        } while (heldOut.isOfSampleBefore(++entry));
      }
      if (!touched) continue;
      veil.light.at(px, py) = glm::vec3(light);
      veil.transmission.at(px, py) = glm::vec3(transmission);
      veil.direct.at(px, py) = glm::vec3(0.0f);
      veil.applied.at(px, py) = glm::vec4(glm::vec3(behind), open);
      veil.frontZ.at(px, py) = front;
      veil.touched.at(px, py) = 1;
      lookedUp.at(px, py) = glm::vec3(elsewhere);
    }
}

void showThroughHeldOut(const Lookups& lookups, const Image<glm::vec3>& lookedUp, Veil& veil) {
  for (int y = 0; y < lookedUp.height(); ++y)
    for (int x = 0; x < lookedUp.width(); ++x) {
      const glm::vec3 share = lookedUp.at(x, y);
      if (share == glm::vec3(0.0f)) continue;
      const glm::vec4 seen = lookups.at(x, y);
      for (int c = 0; c < 3; ++c)
        if (share[c] > 0.0f) veil.applied.at(x, y)[c] += share[c] * seen[c];
      veil.applied.at(x, y).a += shading::meanOf(share) * (1.0f - seen.a);
    }
}

}  // namespace pellucid
