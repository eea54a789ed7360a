#include "composite/pipeline/memory_picture.h"

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "composite/pipeline/output_layers.h"
#include "gbuffer/errors.h"
#include "gbuffer/supersampled.h"
#include "gbuffer/unit_normal.h"

namespace pellucid {
namespace {

constexpr float kNothing = std::numeric_limits<float>::infinity();
constexpr float kFloatPrecision = 0x1p-20f;  // of depth that is stored as float32, as readers have it

void refuseFlagsOfFiles(const ReadOptions& read) {
  const char* flag = read.preset != "auto"                          ? "--preset"
                     : !read.beautyLayer.empty()                    ? "--beauty"
                     : !read.view.empty()                           ? "--view"
                     : read.depthFile || !read.depthChannel.empty() ? "--depth"
                     : !read.aovs.empty()                           ? "--aov"
                     : !read.depthKind.empty()                      ? "--depth-kind"
                     : read.farValue                                ? "--far"
                     : read.metresPerUnit                           ? "--unit"
                                                                    : nullptr;
  if (flag)
    throw UsageError(fmt::format(
        "{}: found it with a picture in memory, expected none: it says how a file is read, and memory holds colours "
        "and planar metres",
        flag));
}

template <class T>
void expectSize(const char* plane, const Image<T>& image, const Image<glm::vec4>& beauty, bool required) {
  if (image.empty() && !required) return;
  if (image.width() != beauty.width() || image.height() != beauty.height())
    throw UsageError(fmt::format("{}: {}: found {}x{} pixels, expected {}x{} as the colours have", kMemoryPicture,
                                 plane, image.width(), image.height(), beauty.width(), beauty.height()));
}

Image<float> openPart(const Image<float>& occlusion) {
  Image<float> open(occlusion.width(), occlusion.height());
  for (std::size_t i = 0; i < open.size(); ++i)
    open[i] = std::isfinite(occlusion[i]) ? std::clamp(occlusion[i], 0.0f, 1.0f) : 1.0f;
  return open;
}

// What all rows come to, by threads that share nothing; `Sum` puts parts together in any order.
template <class Sum, class Row>
Sum overRows(int height, const Row& row) {
  return tbb::parallel_reduce(
      tbb::blocked_range<int>(0, height), Sum(),
      [&](const tbb::blocked_range<int>& rows, Sum sum) {
        for (int y = rows.begin(); y != rows.end(); ++y) row(y, sum);
        return sum;
      },
      [](Sum sum, const Sum& other) {
        sum.add(other);
        return sum;
      });
}

struct DepthScan {
  std::size_t firstOdd = std::numeric_limits<std::size_t>::max();  // pixel whose depth is none
  std::size_t far = 0;                                             // pixels where nothing was hit
  float least = kNothing, most = 0.0f;                             // of the others
  void add(const DepthScan& other) {
    firstOdd = std::min(firstOdd, other.firstOdd);
    far += other.far;
    least = std::min(least, other.least);
    most = std::max(most, other.most);
  }
};

DepthScan scanOf(const Image<float>& viewZ) {
  return overRows<DepthScan>(viewZ.height(), [&](int y, DepthScan& scan) {
    for (int x = 0; x < viewZ.width(); ++x) {
      const float z = viewZ.at(x, y);
      if (z == kNothing) {
        ++scan.far;
        continue;
      }
      if (!(z >= std::numeric_limits<float>::min() && z < kFarthestInMemory))
        scan.firstOdd = std::min(scan.firstOdd, static_cast<std::size_t>(y) * static_cast<std::size_t>(viewZ.width()) +
                                                    static_cast<std::size_t>(x));
      scan.least = std::min(scan.least, z);
      scan.most = std::max(scan.most, z);
    }
  });
}

struct PixelCount {
  std::size_t pixels = 0;
  void add(const PixelCount& other) { pixels += other.pixels; }
};

std::size_t nonFinitePixels(const Image<glm::vec4>& beauty) {
  return overRows<PixelCount>(beauty.height(),
                              [&](int y, PixelCount& count) {
                                for (int x = 0; x < beauty.width(); ++x) {
                                  const glm::vec4& p = beauty.at(x, y);
                                  count.pixels += !std::isfinite(p.r + p.g + p.b + p.a);
                                }
                              })
      .pixels;
}

// What messages and `inspect` say of the depths.
void countDepths(const Image<float>& viewZ, OpaqueChoice& choice) {
  const DepthScan scan = scanOf(viewZ);
  choice.farPixels = scan.far;
  choice.least = scan.far < viewZ.size() ? static_cast<double>(scan.least) : 0.0;
  choice.most = static_cast<double>(scan.most);
}

}  // namespace

MemoryPicture::MemoryPicture(GBuffer planes)
    : planes_(std::move(planes)),
      beauty_(planes_.beauty.data()),
      viewZ_(planes_.viewZ.data()),
      width_(planes_.beauty.width()),
      height_(planes_.beauty.height()) {}

void MemoryPicture::check() const {
  const std::lock_guard lock(mutex_);
  const GBuffer& planes = held();
  if (planes.beauty.empty()) throw UsageError(fmt::format("{}: found no pixels, expected some", kMemoryPicture));
  expectSize("depth", planes.viewZ, planes.beauty, true);
  expectSize("normals", planes_.normal, planes.beauty, false);
  expectSize("occlusion", planes_.occlusion, planes.beauty, false);
  const std::size_t odd = scanOf(planes.viewZ).firstOdd, width = static_cast<std::size_t>(width_);
  if (odd < planes.viewZ.size())
    throw UsageError(
        fmt::format("{}: depth: found {:g} at ({}, {}), expected planar metres above 0 and below {:g}, or +inf where "
                    "nothing was hit",
                    kMemoryPicture, planes.viewZ[odd], odd % width, odd / width, kFarthestInMemory));
}

void MemoryPicture::lend(GBuffer& to) {
  const std::lock_guard lock(mutex_);
  to.display = planes_.display;
  to.data = planes_.data;
  to.pixelAspect = planes_.pixelAspect;
  to.hasAlpha = planes_.hasAlpha;
  to.camera = planes_.camera;
  to.normal = planes_.normal;
  for (std::size_t i = 0; i < to.normal.size(); ++i) to.normal[i] = unitNormal(to.normal[i]);
  if (!planes_.occlusion.empty()) to.occlusion = openPart(planes_.occlusion);
  if (holder_) {
    to.beauty = holder_->beauty;
    to.viewZ = holder_->viewZ;
    return;
  }
  to.beauty = std::move(planes_.beauty);
  to.viewZ = std::move(planes_.viewZ);
  holder_ = &to;
}

void MemoryPicture::takeBack(GBuffer& from) {
  const std::lock_guard lock(mutex_);
  if (holder_ != &from) return;
  planes_.beauty = std::move(from.beauty);
  planes_.viewZ = std::move(from.viewZ);
  holder_ = nullptr;
}

void checkMemoryPicture(const ShotRequest& request) {
  if (!request.memory) return;
  refuseFlagsOfFiles(request.read);
  request.memory->check();
}

void readMemoryPicture(MemoryPicture& picture, OpaqueFile& file) {
  GBuffer& gbuffer = file.gbuffer;
  picture.lend(gbuffer);
  gbuffer.depthPrecision = kFloatPrecision;
  ExrPart part;
  part.display = gbuffer.display;
  part.data = gbuffer.data;
  part.pixelAspect = gbuffer.pixelAspect;
  file.document.path = kMemoryPicture;
  file.document.parts.push_back(std::move(part));
  file.document.ownParts = 1;
  const char* names[] = {"R", "G", "B", "A"};
  for (int c = 0; c < (gbuffer.hasAlpha ? 4 : 3); ++c) file.choice.beautyChannel[c] = names[c];
  file.choice.depthChannel = "depth";
  file.choice.depthKind = "planar";
  file.choice.farValue = static_cast<double>(kFarthestInMemory);
  countDepths(gbuffer.viewZ, file.choice);
  file.choice.nonFiniteColour = nonFinitePixels(gbuffer.beauty);
  if (file.choice.nonFiniteColour > 0)
    file.notes.push_back(fmt::format("colour: {} pixels are not finite", file.choice.nonFiniteColour));
}

std::vector<std::string> writeFromMemory(const std::string& path, const OpaqueFile& opaque, const Camera* camera,
                                         const Image<glm::vec4>& beauty, const std::vector<ExtraLayer>& layers,
                                         const std::map<std::string, std::string>& attributes, int samples) {
  const GBuffer& gbuffer = opaque.gbuffer;
  ExtraLayer colours = beautyLayer(beauty), planes{"", {}}, normals{"N", {}};
  if (!gbuffer.hasAlpha) colours.channels.pop_back();
  planes.channels.emplace_back("Z", gbuffer.viewZ);
  if (!gbuffer.occlusion.empty()) planes.channels.emplace_back("AO", gbuffer.occlusion);
  if (!gbuffer.normal.empty()) {
    const char* names[] = {"X", "Y", "Z"};
    for (int c = 0; c < 3; ++c) {
      Image<float> plane(gbuffer.normal.width(), gbuffer.normal.height());
      for (std::size_t i = 0; i < plane.size(); ++i) plane[i] = gbuffer.normal[i][c];
      normals.channels.emplace_back(names[c], std::move(plane));
    }
  }
  std::vector<ExtraLayer> all{std::move(colours)};
  for (const ExtraLayer& each : {planes, normals}) all.push_back(samples > 1 ? pixelsOf(each, samples) : each);
  all.insert(all.end(), layers.begin(), layers.end());
  return writeLayers(path, pixelsOf(gbuffer.display, samples), pixelsOf(gbuffer.data, samples), all, attributes, camera,
                     false, nullptr, chromaticitiesToWrite(opaque.space));
}

}  // namespace pellucid
