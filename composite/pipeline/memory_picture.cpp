#include "composite/pipeline/memory_picture.h"

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <iterator>
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

float openPart(float occlusion) {
  return std::isfinite(occlusion) ? std::clamp(occlusion, 0.0f, 1.0f) : 1.0f;
}

template <class T, class Conversion>
Image<T> converted(const Image<T>& image, const Conversion& conversion) {
  Image<T> made(image.width(), image.height());
  tbb::parallel_for(tbb::blocked_range<int>(0, image.height()), [&](const tbb::blocked_range<int>& rows) {
    for (int y = rows.begin(); y != rows.end(); ++y)
      std::transform(image.row(y), image.row(y) + image.width(), made.row(y), conversion);
  });
  return made;
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

// Numbers that are looked at side by side: compilers make vectors of loops over them.
constexpr int kLanes = 16;

// Calls lanes.look(number, lane) for all of a row.
template <class Lanes>
void overLanes(const float* row, std::size_t size, Lanes& lanes) {
  std::size_t i = 0;
  for (; i + kLanes <= size; i += kLanes)
    for (int lane = 0; lane < kLanes; ++lane) lanes.look(row[i + static_cast<std::size_t>(lane)], lane);
  for (; i < size; ++i) lanes.look(row[i], 0);
}

// Positive floats are in the order of their bits as integers, and negative ones are negative: comparing those costs
// less.
std::int32_t bitsOf(float value) {
  return std::bit_cast<std::int32_t>(value);
}
constexpr std::int32_t kNothingBits = std::bit_cast<std::int32_t>(kNothing);

bool isDepth(std::int32_t bits) {
  constexpr auto kLeast = std::bit_cast<std::int32_t>(std::numeric_limits<float>::min());
  constexpr auto kFarthest = std::bit_cast<std::int32_t>(kFarthestInMemory);
  return (bits >= kLeast) & (bits < kFarthest);
}

struct DepthScan {
  std::size_t odd = 0, far = 0;                 // pixels whose depth is none; where nothing was hit
  std::int32_t least = kNothingBits, most = 0;  // of the others
  void add(const DepthScan& other) {
    odd += other.odd;
    far += other.far;
    least = std::min(least, other.least);
    most = std::max(most, other.most);
  }
};

struct DepthLanes {
  std::int32_t hits[kLanes] = {}, far[kLanes] = {}, least[kLanes], most[kLanes] = {};
  DepthLanes() { std::fill(std::begin(least), std::end(least), kNothingBits); }
  void look(float z, int lane) {
    const std::int32_t bits = bitsOf(z), hit = -static_cast<std::int32_t>(isDepth(bits));  // all bits set, or none
    const std::int32_t low = (bits & hit) | (kNothingBits & ~hit), high = bits & hit;
    hits[lane] -= hit;
    far[lane] += static_cast<std::int32_t>(bits == kNothingBits);
    least[lane] = low < least[lane] ? low : least[lane];
    most[lane] = high > most[lane] ? high : most[lane];
  }
};

DepthScan scanOf(const Image<float>& viewZ) {
  const auto width = static_cast<std::size_t>(viewZ.width());
  return overRows<DepthScan>(viewZ.height(), [&](int y, DepthScan& scan) {
    DepthLanes lanes;
    overLanes(viewZ.row(y), width, lanes);
    std::size_t good = 0;
    for (int lane = 0; lane < kLanes; ++lane) {
      good += static_cast<std::size_t>(lanes.hits[lane] + lanes.far[lane]);
      scan.add({0, static_cast<std::size_t>(lanes.far[lane]), lanes.least[lane], lanes.most[lane]});
    }
    scan.odd += width - good;
  });
}

struct PixelCount {
  std::size_t pixels = 0;
  void add(const PixelCount& other) { pixels += other.pixels; }
};

// A row without a number this large has finite colours, and so are sums of four of its numbers.
constexpr std::uint32_t kLarge = 0x7e000000;  // 2^125

struct LargeLanes {
  std::uint32_t large[kLanes] = {};
  void look(float value, int lane) { large[lane] |= (std::bit_cast<std::uint32_t>(value) << 1) >= kLarge << 1; }
};

bool hasLarge(const float* row, std::size_t size) {
  LargeLanes lanes;
  overLanes(row, size, lanes);
  return std::any_of(std::begin(lanes.large), std::end(lanes.large), [](std::uint32_t any) { return any != 0; });
}

std::size_t nonFinitePixels(const Image<glm::vec4>& beauty) {
  const auto width = static_cast<std::size_t>(beauty.width());
  return overRows<PixelCount>(
             beauty.height(),
             [&](int y, PixelCount& count) {
               const glm::vec4* row = beauty.row(y);
               if (!hasLarge(&row->r, 4 * width)) return;
               count.pixels += static_cast<std::size_t>(std::count_if(
                   row, row + width, [](const glm::vec4& p) { return !std::isfinite(p.r + p.g + p.b + p.a); }));
             })
      .pixels;
}

// Checks the depths, and counts what messages and `inspect` say of them.
void readDepths(const Image<float>& viewZ, OpaqueChoice& choice) {
  const DepthScan scan = scanOf(viewZ);
  if (scan.odd > 0) {
    const float* first = std::find_if(viewZ.data(), viewZ.data() + viewZ.size(),
                                      [](float z) { return !isDepth(bitsOf(z)) && z != kNothing; });
    const auto pixel = static_cast<std::size_t>(first - viewZ.data()), width = static_cast<std::size_t>(viewZ.width());
    throw UsageError(
        fmt::format("{}: depth: found {:g} at ({}, {}), expected planar metres above 0 and below {:g}, or +inf where "
                    "nothing was hit",
                    kMemoryPicture, *first, pixel % width, pixel / width, kFarthestInMemory));
  }
  choice.farPixels = scan.far;
  choice.least = scan.far < viewZ.size() ? static_cast<double>(std::bit_cast<float>(scan.least)) : 0.0;
  choice.most = static_cast<double>(std::bit_cast<float>(scan.most));
}

}  // namespace

void checkMemoryPicture(const ShotRequest& request) {
  if (!request.memory) return;
  refuseFlagsOfFiles(request.read);
  const GBuffer& planes = *request.memory;
  if (planes.beauty.empty()) throw UsageError(fmt::format("{}: found no pixels, expected some", kMemoryPicture));
  expectSize("depth", planes.viewZ, planes.beauty, true);
  expectSize("normals", planes.normal, planes.beauty, false);
  expectSize("occlusion", planes.occlusion, planes.beauty, false);
}

void readMemoryPicture(const std::shared_ptr<const GBuffer>& picture, OpaqueFile& file) {
  GBuffer& gbuffer = file.gbuffer;
  gbuffer.display = picture->display;
  gbuffer.data = picture->data;
  gbuffer.pixelAspect = picture->pixelAspect;
  gbuffer.hasAlpha = picture->hasAlpha;
  gbuffer.camera = picture->camera;
  gbuffer.beauty = picture->beauty.shown(picture);
  gbuffer.viewZ = picture->viewZ.shown(picture);
  gbuffer.depthPrecision = kFloatPrecision;
  gbuffer.normal = converted(picture->normal, unitNormal);
  gbuffer.occlusion = converted(picture->occlusion, openPart);
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
  readDepths(gbuffer.viewZ, file.choice);
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
