#include "composite/pipeline/memory_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "composite/pipeline/output_layers.h"
#include "gbuffer/errors.h"
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

// What messages and `inspect` say of the depths.
void countDepths(const Image<float>& viewZ, OpaqueChoice& choice) {
  float least = kNothing, most = 0.0f;
  for (std::size_t i = 0; i < viewZ.size(); ++i) {
    if (viewZ[i] == kNothing) {
      ++choice.farPixels;
      continue;
    }
    least = std::min(least, viewZ[i]);
    most = std::max(most, viewZ[i]);
  }
  choice.least = choice.farPixels < viewZ.size() ? static_cast<double>(least) : 0.0;
  choice.most = static_cast<double>(most);
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
  const auto width = static_cast<std::size_t>(width_);
  for (std::size_t i = 0; i < planes.viewZ.size(); ++i) {
    const float z = planes.viewZ[i];
    if (z == kNothing || (z >= std::numeric_limits<float>::min() && z < kFarthestInMemory)) continue;
    throw UsageError(
        fmt::format("{}: depth: found {:g} at ({}, {}), expected planar metres above 0 and below {:g}, or +inf where "
                    "nothing was hit",
                    kMemoryPicture, z, i % width, i / width, kFarthestInMemory));
  }
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
  for (std::size_t i = 0; i < gbuffer.beauty.size(); ++i) {
    const glm::vec4& p = gbuffer.beauty[i];
    if (!std::isfinite(p.r + p.g + p.b + p.a)) ++file.choice.nonFiniteColour;
  }
  if (file.choice.nonFiniteColour > 0)
    file.notes.push_back(fmt::format("colour: {} pixels are not finite", file.choice.nonFiniteColour));
}

std::vector<std::string> writeFromMemory(const std::string& path, const OpaqueFile& opaque, const Camera* camera,
                                         const Image<glm::vec4>& beauty, const std::vector<ExtraLayer>& layers,
                                         const std::map<std::string, std::string>& attributes) {
  const GBuffer& gbuffer = opaque.gbuffer;
  std::vector<ExtraLayer> all{beautyLayer(beauty)};
  if (!gbuffer.hasAlpha) all[0].channels.pop_back();
  all[0].channels.emplace_back("Z", gbuffer.viewZ);
  if (!gbuffer.occlusion.empty()) all[0].channels.emplace_back("AO", gbuffer.occlusion);
  if (!gbuffer.normal.empty()) {
    ExtraLayer normals{"N", {}};
    const char* names[] = {"X", "Y", "Z"};
    for (int c = 0; c < 3; ++c) {
      Image<float> plane(beauty.width(), beauty.height());
      for (std::size_t i = 0; i < plane.size(); ++i) plane[i] = gbuffer.normal[i][c];
      normals.channels.emplace_back(names[c], std::move(plane));
    }
    all.push_back(std::move(normals));
  }
  all.insert(all.end(), layers.begin(), layers.end());
  return writeLayers(path, gbuffer.display, gbuffer.data, all, attributes, camera, false, nullptr,
                     chromaticitiesToWrite(opaque.space));
}

}  // namespace pellucid
