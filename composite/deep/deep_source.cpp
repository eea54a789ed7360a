#include "composite/deep/deep_source.h"

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>
#include <utility>

#include "gbuffer/errors.h"
#include "shaders/shading.h"

namespace pellucid {
namespace {

std::string windowText(const Window& w) {
  return fmt::format("({}, {})-({}, {})", w.x0, w.y0, w.x1 - 1, w.y1 - 1);
}

// Integer hash of where a sample comes from: the same whatever the bands and threads.
std::uint32_t identityOf(std::uint32_t source, int x, int y, std::uint64_t sample) {
  std::uint32_t h = source * 0x9e3779b9u ^ static_cast<std::uint32_t>(x) * 0x85ebca6bu ^
                    static_cast<std::uint32_t>(y) * 0xc2b2ae35u ^ static_cast<std::uint32_t>(sample) * 0x27d4eb2fu;
  h = (h ^ (h >> 16)) * 0x7feb352du;
  h = (h ^ (h >> 15)) * 0x846ca68bu;
  return h ^ (h >> 16);
}

std::size_t pixelOf(const Window& window, int x, int y) {
  return static_cast<std::size_t>(y - window.y0) * static_cast<std::size_t>(window.width()) +
         static_cast<std::size_t>(x - window.x0);
}

bool contains(const Window& window, int x, int y) {
  return x >= window.x0 && x < window.x1 && y >= window.y0 && y < window.y1;
}

// Of a file that tells no views apart all eyes see the same.
DeepChannels layersOfView(const ExrDocument& document, const std::string& view) {
  return resolveDeep(document, tellsViews(document) ? view : "");
}

}  // namespace

DeepSource::DeepSource(const std::string& path, const DepthConverter& depth, const GBuffer& shot, std::uint32_t index,
                       const std::string& view)
    : path_(path),
      depth_(depth),
      index_(index),
      channels_(layersOfView(readExr(path), view)),
      reader_(path, channels_.part, channels_.names) {
  expectCameraPicture(channels_, path);
  // `fragments` wrote it: it says itself how it is read, whatever the picture's depth means.
  if (channels_.hasRecord()) depth_ = depth.planar();
  if (reader_.display() != shot.display)
    throw MeaningError(fmt::format("{}: found display window {}, expected {} of the opaque picture", path,
                                   windowText(reader_.display()), windowText(shot.display)));
}

void DeepSource::bringInto(const ColourSpace& space) {
  const std::optional<ColourSpace> own =
      channels_.chromaticities ? spaceOf(*channels_.chromaticities) : std::optional<ColourSpace>();
  toSpace_.reset();
  if (own && !sameSpace(*own, space)) toSpace_ = space.fromRec709 * glm::inverse(own->fromRec709);
}

std::vector<std::string> DeepSource::notes() const {
  std::vector<std::string> notes;
  if (!channels_.note.empty()) notes.push_back(channels_.note);
  if (oddities_.notFinite)
    notes.push_back(fmt::format("{}: {} deep samples are not numbers and were skipped", path_, oddities_.notFinite));
  if (oddities_.outOfRange)
    notes.push_back(fmt::format("{}: {} deep samples have an opacity outside 0 to 1, which was clamped", path_,
                                oddities_.outOfRange));
  return notes;
}

// One band: the rows of every source beside the lists, pixel by pixel.
class DeepMerge {
 public:
  DeepMerge(const FragmentLists& lists, std::span<const std::unique_ptr<DeepSource>> sources, const GBuffer& shot,
            VolumeRule rule)
      : lists_(lists), sources_(sources), shot_(shot), rule_(rule) {}

  // Reads rows from y on and merges them. Returns the row to go on from.
  int band(int y, std::uint64_t most, FragmentLists& merged) {
    int end = lists_.window.y1;
    rows_.resize(sources_.size());
    for (std::size_t s = 0; s < sources_.size(); ++s) {
      DeepReader& reader = sources_[s]->reader_;
      const Window& data = reader.data();
      const int from = std::max(y, data.y0), to = std::min(end, data.y1);
      rows_[s] = from < to ? reader.read(from, to, most, std::move(rows_[s])) : DeepRows{};
      // Later sources follow the first that had to stop early.
      if (from < to) end = std::min(end, rows_[s].window.y1);
    }
    merged.window = {lists_.window.x0, y, lists_.window.x1, end};
    merged.solid = Image<glm::vec4>(merged.window.width(), merged.window.height());
    const auto height = static_cast<std::size_t>(merged.window.height());
    const auto width = static_cast<std::size_t>(merged.window.width());
    std::vector<FragmentLists> rows(height);
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, height), [&](const tbb::blocked_range<std::size_t>& range) {
      std::vector<DeepOddities> oddities(sources_.size());
      Scratch scratch;
      for (std::size_t r = range.begin(); r != range.end(); ++r) {
        rows[r].offsets.reserve(width);
        for (int x = merged.window.x0; x < merged.window.x1; ++x) {
          const int py = y + static_cast<int>(r);
          merged.solid.at(x - merged.window.x0, static_cast<int>(r)) = pixel(x, py, rows[r], scratch, oddities);
          rows[r].endPixel();
        }
      }
      const std::lock_guard lock(mutex_);
      for (std::size_t s = 0; s < sources_.size(); ++s) sources_[s]->oddities_.add(oddities[s]);
    });
    merged.offsets.assign(1, 0);
    merged.fragments.clear();
    merged.clearColumns();
    for (FragmentLists& row : rows) {
      const std::uint64_t before = merged.fragments.size();
      for (const std::uint64_t last : row.offsets) merged.offsets.push_back(before + last);
      merged.append(row, 0, row.fragments.size());
      row = FragmentLists();
    }
    merged.addColumnsOf(lists_);
    return end;
  }

 private:
  // The nearest opaque samples of a pixel, by the rules of visitTidy(): those at one depth average among themselves,
  // and points come before the volumes that begin there.
  struct Opaque {
    glm::dvec3 light{0.0};
    double count = 0.0;
    float z = std::numeric_limits<float>::infinity();
    bool point = false;
    void add(const DeepSample& sample) {
      const auto at = static_cast<float>(sample.z);
      if (at > z || (at == z && point && sample.isVolume())) return;
      if (at < z || point == sample.isVolume()) *this = {.z = at, .point = !sample.isVolume()};
      light += sample.light;
      count += 1.0;
    }
    glm::vec4 solid() const { return {glm::vec3(light / count), z}; }
  };

  struct Scratch {
    std::vector<DeepSample> volumes;
    std::vector<double> cuts;
    std::vector<std::size_t> plain;  // fragments of samples that other renderers wrote
  };

  // Light goes through the matrix, and so does the white light that is let through or hidden.
  static void convert(const glm::dmat3& matrix, DeepSample& sample) {
    sample.light = matrix * sample.light;
    const double grey = std::min({sample.opacity.x, sample.opacity.y, sample.opacity.z});  // which keeps its bits
    const glm::dvec3 hidden = grey + matrix * (glm::dvec3(sample.opacity) - grey);
    sample.opacity = glm::dvec4(glm::clamp(hidden, glm::dvec3(0.0), glm::dvec3(1.0)), sample.opacity.w);
  }
  static Fragment converted(const glm::dmat3& matrix, Fragment fragment) {
    fragment.radiance = glm::vec3(matrix * glm::dvec3(fragment.radiance));
    fragment.transmission = glm::min(pellucid::converted(matrix, fragment.transmission), glm::vec3(1.0f));
    return fragment;
  }
  static Fragment recordOf(const DeepSource& source, const DeepRows& rows, std::uint64_t i, double z) {
    const Fragment record = recordAt(source.channels_, rows, i, z);
    return source.toSpace_ ? converted(*source.toSpace_, record) : record;
  }

  // Appends the pixel's fragments, returns its solid.
  glm::vec4 pixel(int x, int y, FragmentLists& out, Scratch& scratch, std::vector<DeepOddities>& oddities) {
    const std::size_t own = pixelOf(lists_.window, x, y), had = out.fragments.size();
    glm::vec4 solid = lists_.solid.at(x - lists_.window.x0, y - lists_.window.y0);
    out.append(lists_, lists_.offsets[own], lists_.offsets[own + 1]);
    const double surface = static_cast<double>(shot_.viewZ.at(x - shot_.data.x0, y - shot_.data.y0)) *
                           (1.0 + static_cast<double>(shot_.depthPrecision));
    scratch.volumes.clear();
    scratch.plain.clear();
    Opaque nearest;
    for (std::size_t s = 0; s < sources_.size(); ++s) {
      const DeepSource& source = *sources_[s];
      if (!contains(rows_[s].window, x, y)) continue;
      const std::size_t index = pixelOf(rows_[s].window, x, y);
      const std::uint64_t first = rows_[s].offsets[index];
      for (std::uint64_t i = first; i < rows_[s].offsets[index + 1]; ++i) {
        DeepSample sample;
        if (!sampleAt(source.channels_, rows_[s], i, source.depth_, x, y, sample, oddities[s])) continue;
        if (source.toSpace_) convert(*source.toSpace_, sample);
        if (!(sample.z > 0.0) || sample.z > surface) continue;  // behind the camera or the surface
        // A record may bend or spread light without hiding any; nothing else is a layer that does neither.
        if (!source.channels_.hasRecord() && sample.opacity == glm::dvec4(0.0) && sample.light == glm::dvec3(0.0))
          continue;
        if (sample.isVolume() && sample.zBack > surface) sample = partOfVolume(sample, sample.z, surface);
        const bool opaque = sample.opacity.x >= 1.0 && sample.opacity.y >= 1.0 && sample.opacity.z >= 1.0;
        if (opaque) {
          nearest.add(sample);  // from its very front on
          continue;
        }
        if (sample.isVolume() && rule_ == VolumeRule::split) {
          scratch.volumes.push_back(sample);
          continue;
        }
        Fragment fragment = source.channels_.hasRecord() ? recordOf(source, rows_[s], i, sample.z)
                                                         : fragmentAt(sample, 0.5 * (sample.z + sample.zBack));
        fragment.identity = identityOf(source.index_, x, y, i - first);
        if (!source.channels_.hasRecord()) scratch.plain.push_back(out.fragments.size());
        out.append(fragment);
      }
    }
    if (nearest.count > 0.0 && nearest.z <= solid.a) {
      // It hides what other renderers' samples have at its depth; anything else there lies on it. Of two solids at one
      // depth the larger, channel by channel, whatever the order.
      for (const std::size_t i : scratch.plain)
        if (nearest.point && out.fragments[i].z == nearest.z)
          out.fragments[i].z = std::nextafter(nearest.z, std::numeric_limits<float>::infinity());
      solid = nearest.z < solid.a ? nearest.solid() : glm::max(solid, nearest.solid());
    }
    std::erase_if(scratch.volumes, [&](const DeepSample& v) { return v.z > static_cast<double>(solid.a); });
    if (!scratch.volumes.empty()) splitVolumes(scratch, out, had, static_cast<double>(solid.a), x, y);
    out.keepFrom(had, [&](const Fragment& fragment) { return !(fragment.z > solid.a); });
    return solid;
  }

  void splitVolumes(Scratch& scratch, FragmentLists& out, std::size_t had, double solidZ, int x, int y) const {
    for (DeepSample& volume : scratch.volumes)
      if (volume.zBack > solidZ && volume.z < solidZ) volume = partOfVolume(volume, volume.z, solidZ);
    scratch.cuts.clear();
    for (std::size_t i = had; i < out.fragments.size(); ++i)
      scratch.cuts.push_back(static_cast<double>(out.fragments[i].z));
    std::sort(scratch.cuts.begin(), scratch.cuts.end());
    std::uint64_t piece = 0;
    visitTidy(scratch.volumes, scratch.cuts, [&](const DeepSample& sample) {
      Fragment fragment = fragmentAt(sample, 0.5 * (sample.z + sample.zBack));
      fragment.identity = identityOf(0xffffffffu, x, y, piece++);
      out.append(fragment);
    });
  }

  const FragmentLists& lists_;
  std::span<const std::unique_ptr<DeepSource>> sources_;
  const GBuffer& shot_;
  VolumeRule rule_;
  std::vector<DeepRows> rows_;
  std::mutex mutex_;
};

void mergeDeep(const FragmentLists& lists, std::span<const std::unique_ptr<DeepSource>> sources, const GBuffer& shot,
               VolumeRule rule, std::uint64_t most, const std::function<void(const FragmentLists&)>& band) {
  DeepMerge merge(lists, sources, shot, rule);
  FragmentLists merged;
  for (int y = lists.window.y0; y < lists.window.y1;) {
    y = merge.band(y, most, merged);
    band(merged);
  }
}

}  // namespace pellucid
