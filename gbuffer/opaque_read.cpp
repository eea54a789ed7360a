#include <fmt/format.h>

#include <cmath>
#include <cstring>

#include "gbuffer/channels.h"
#include "gbuffer/depth.h"
#include "gbuffer/errors.h"
#include "gbuffer/object_coverage.h"
#include "gbuffer/opaque_io.h"
#include "gbuffer/part_camera.h"
#include "gbuffer/pixel_rows.h"
#include "gbuffer/producers.h"
#include "gbuffer/side_files.h"
#include "gbuffer/unit_normal.h"

namespace pellucid {
namespace {

const ExrPart& partOf(const OpaqueFile& file, int index) {
  return file.document.parts[static_cast<std::size_t>(index)];
}

template <class Number>
glm::dmat4 matrixFrom(const std::string& bytes) {
  Number numbers[16];
  std::memcpy(numbers, bytes.data(), sizeof numbers);
  glm::dmat4 rows;
  for (int i = 0; i < 16; ++i) rows[i / 4][i % 4] = static_cast<double>(numbers[i]);
  return rows;
}

//   found  is told of an attribute that is no matrix
std::optional<glm::dmat4> matrixOf(const ExrPart& part, const char* name, std::string& found) {
  const auto attribute = part.attributes.find(name);
  if (attribute == part.attributes.end()) return std::nullopt;
  const auto& [type, bytes] = attribute->second;
  if (type == "m44f" && bytes.size() == 64) return matrixFrom<float>(bytes);
  if (type == "m44d" && bytes.size() == 128) return matrixFrom<double>(bytes);
  found = fmt::format("attribute {}: found {} of {} bytes, expected m44f, so no camera from the file", name, type,
                      bytes.size());
  return std::nullopt;
}

double floatOf(const ExrPart& part, const char* name) {
  const auto found = part.attributes.find(name);
  if (found == part.attributes.end() || found->second.type != "float" || found->second.bytes.size() != 4) return 0.0;
  float number = 0;
  std::memcpy(&number, found->second.bytes.data(), sizeof number);
  return std::isfinite(number) && number > 0.0f ? static_cast<double>(number) : 0.0;
}

void readBeauty(const BeautyChannels& beauty, OpaqueFile& file) {
  GBuffer& gbuffer = file.gbuffer;
  const ExrPart& part = partOf(file, beauty.part);
  gbuffer.beauty = Image<glm::vec4>(gbuffer.data.width(), gbuffer.data.height(), glm::vec4(0.0f, 0.0f, 0.0f, 1.0f));
  for (int c = 0; c < 4; ++c) {
    if (!beauty.channel[c]) continue;
    file.choice.beautyChannel[c] = beauty.channel[c]->name;
    visitPixels(*beauty.channel[c], part.data, gbuffer.data,
                [&](int x, int y, float value) { gbuffer.beauty.at(x, y)[c] = value; });
  }
  std::size_t first = 0;
  for (std::size_t i = 0; i < gbuffer.beauty.size(); ++i) {
    const glm::vec4& p = gbuffer.beauty[i];
    if (std::isfinite(p.r) && std::isfinite(p.g) && std::isfinite(p.b) && std::isfinite(p.a)) continue;
    if (file.choice.nonFiniteColour++ == 0) first = i;
  }
  if (file.choice.nonFiniteColour > 0) {
    const auto width = static_cast<std::size_t>(gbuffer.data.width());
    file.notes.push_back(fmt::format("colour {}: {} pixels are not finite, first at ({}, {})",
                                     beauty.layerName.empty() ? "RGB" : beauty.layerName, file.choice.nonFiniteColour,
                                     gbuffer.data.x0 + static_cast<int>(first % width),
                                     gbuffer.data.y0 + static_cast<int>(first / width)));
  }
}

// Sample images of OpenEXR's own: DWA keeps all but R, G, B and Y; B44 codes every half; PXR24 rounds floats.
bool arrivesRounded(const ExrPart& part, const ExrChannel& channel) {
  const std::string suffix = channel.name.substr(channel.name.rfind('.') + 1);
  if (part.compression.starts_with("dwa")) return suffix == "R" || suffix == "G" || suffix == "B" || suffix == "Y";
  if (part.compression.starts_with("b44")) return channel.type == PixelType::half;
  return part.compression == "pxr24" && channel.type == PixelType::float32;
}

void noteRounded(const ExrPart& part, const ExrChannel& channel, OpaqueFile& file) {
  if (arrivesRounded(part, channel))
    file.notes.push_back(
        fmt::format("channel {} is data, but {} compression has changed its values", channel.name, part.compression));
}

void readNormals(const PassChannels& pass, bool zUp, OpaqueFile& file) {
  GBuffer& gbuffer = file.gbuffer;
  const ExrPart& part = partOf(file, pass.part);
  gbuffer.normal = Image<glm::vec3>(gbuffer.data.width(), gbuffer.data.height(), glm::vec3(0.0f));
  for (int c = 0; c < 3; ++c) {
    noteRounded(part, *pass.channel[c], file);
    visitPixels(*pass.channel[c], part.data, gbuffer.data,
                [&](int x, int y, float value) { gbuffer.normal.at(x, y)[c] = value; });
  }
  for (std::size_t i = 0; i < gbuffer.normal.size(); ++i) {
    glm::vec3& n = gbuffer.normal[i];
    n = unitNormal(n);
    if (zUp) n = glm::vec3(n.x, n.z, -n.y);
  }
  if (zUp) file.notes.push_back(fmt::format("normals {}: turned from Blender's z-up world to y-up", pass.layerName));
}

void readOcclusion(const PassChannels& pass, OpaqueFile& file) {
  GBuffer& gbuffer = file.gbuffer;
  const ExrPart& part = partOf(file, pass.part);
  float count = 0.0f;
  for (const ExrChannel* channel : pass.channel) count += channel ? 1.0f : 0.0f;
  gbuffer.occlusion = Image<float>(gbuffer.data.width(), gbuffer.data.height(), 0.0f);
  for (const ExrChannel* channel : pass.channel) {
    if (!channel) continue;
    noteRounded(part, *channel, file);
    visitPixels(*channel, part.data, gbuffer.data,
                [&](int x, int y, float value) { gbuffer.occlusion.at(x, y) += value / count; });
  }
  // Outside the pass, and where it is not a number, nothing occludes.
  Image<std::uint8_t> covered(gbuffer.data.width(), gbuffer.data.height(), 0);
  visitPixels(*pass.channel[0], part.data, gbuffer.data, [&](int x, int y, float) { covered.at(x, y) = 1; });
  for (std::size_t i = 0; i < gbuffer.occlusion.size(); ++i) {
    float& ao = gbuffer.occlusion[i];
    ao = covered[i] && std::isfinite(ao) ? std::clamp(ao, 0.0f, 1.0f) : 1.0f;
  }
}

void checkOptions(const ReadOptions& options) {
  const double unit = options.metresPerUnit.value_or(1.0);
  if (!(unit > 0.0) || !std::isfinite(unit))
    throw UsageError(fmt::format("--unit: found {}, expected metres above 0", unit));
  if (!options.depthKind.empty()) parseDepthKind(options.depthKind);
}

// Pictures that no pinhole or orthographic camera has taken.
void refuseEnvironmentMaps(const ExrPart& part, const std::string& path) {
  const auto found = part.attributes.find("envmap");
  if (found == part.attributes.end()) return;
  const bool cube = found->second.bytes.size() == 1 && found->second.bytes[0] == 1;
  throw MeaningError(fmt::format("{}: attribute envmap: found a {} map, expected a picture that a camera has taken",
                                 path, cube ? "cube" : "lat-long"));
}

void readOtherPasses(const std::vector<NamedChannel>& channels, const BeautyChannels& beauty, const Producer* producer,
                     OpaqueFile& file) {
  const NormalSpace space = producer ? producer->normals : NormalSpace::world;
  // What was named wins over what lies in the picture's own file.
  const auto passOf = [&](Pass pass) {
    std::vector<NamedChannel> beside = channels;
    std::erase_if(beside,
                  [&](const NamedChannel& c) { return static_cast<std::size_t>(c.part) < file.document.ownParts; });
    const auto found = resolvePass(beside, beauty, pass);
    return found ? found : resolvePass(channels, beauty, pass);
  };
  if (const auto normals = passOf(Pass::normal)) {
    if (space == NormalSpace::camera)
      file.notes.push_back(
          fmt::format("normals {}: left out, {} writes them in camera space", normals->layerName, producer->title));
    else
      readNormals(*normals, space == NormalSpace::worldZUp, file);
  }
  if (const auto occlusion = passOf(Pass::occlusion)) readOcclusion(*occlusion, file);
}

// What --depth-kind says, else what the producer writes. A channel that --depth names beside its own is planar; of one
// who writes distances along rays, such as Mitsuba 2 in a channel of any name, the planes decide.
DepthKind kindOf(const ReadOptions& options, const Producer* producer, const std::vector<NamedChannel>& channels,
                 const NamedChannel& depth) {
  if (!options.depthKind.empty()) return parseDepthKind(options.depthKind);
  const bool another =
      !options.depthChannel.empty() && producer && *producer->depth && !isDepthOf(*producer, channels, depth);
  if (!another) return parseDepthKind(producer ? producer->kind : "planar");
  const bool rays = parseDepthKind(producer->kind).meaning == DepthMeaning::ray && !positionsOf(channels, depth);
  return parseDepthKind(rays ? "planar|ray" : "planar");
}

// What our own G-buffers say in their header, else what the producer uses unless it is told otherwise.
void readPixelFilter(const ExrPart& part, const Producer* producer, OpaqueFile& file) {
  if (const std::optional<std::string> text = part.text(kFilterAttribute)) {
    file.choice.pixelFilter = pixelFilterOf(*text);
    file.choice.pixelFilterBy = "as the picture's header says";
    if (!file.choice.pixelFilter)
      file.notes.push_back(fmt::format("{}: found '{}', expected a shape and a radius, as 'box:0.5': not taken",
                                       kFilterAttribute, *text));
    return;
  }
  if (!producer || !*producer->pixelFilter) return;
  file.choice.pixelFilter = parsePixelFilter(producer->pixelFilter);
  file.choice.pixelFilterBy = fmt::format("which {} uses by default", producer->title);
}

}  // namespace

void readCamera(const ExrPart& part, double unit, OpaqueFile& file) {
  std::string strange;
  const auto worldToCamera = matrixOf(part, "worldToCamera", strange),
             worldToNdc = matrixOf(part, "worldToNDC", strange);
  if (!strange.empty())
    file.notes.push_back(file.cameraRefusal = strange);
  else if (worldToCamera.has_value() != worldToNdc.has_value())
    file.notes.push_back(file.cameraRefusal =
                             fmt::format("found the attribute {} without {}, so no camera from the file",
                                         worldToCamera ? "worldToCamera" : "worldToNDC",
                                         worldToCamera ? "worldToNDC" : "worldToCamera"));
  if (!worldToCamera || !worldToNdc) return;
  try {
    Camera camera = cameraFromExr(*worldToCamera, *worldToNdc, file.document.path);
    camera.viewFromWorld[3] = glm::dvec4(glm::dvec3(camera.viewFromWorld[3]) * unit, 1.0);
    if (camera.orthographic) camera.focal /= unit;
    camera.rangeNear = unit * floatOf(part, "arnold/camera/near_clip");
    camera.rangeFar = unit * floatOf(part, "arnold/camera/far_clip");
    file.gbuffer.camera = camera;
    if (camera.origin.find(',') != std::string::npos) file.notes.push_back("camera from " + camera.origin);
  } catch (const MeaningError& error) {
    file.notes.push_back(error.what());
    file.cameraRefusal = error.what();
  }
}

OpaqueFile interpretOpaque(ExrDocument document, const ReadOptions& options, const Camera* camera) {
  checkOptions(options);
  OpaqueFile file;
  file.document = std::move(document);
  file.notes = file.document.notes;
  const std::vector<NamedChannel> all = nameChannels(file.document), channels = ownChannels(file.document, all);
  const RecognisedProducer recognised = recogniseProducer(file.document, all, options.preset);
  const Producer* producer = recognised.row;
  const BeautyChannels beauty = resolveBeauty(file.document, channels, options.beautyLayer, options.view, producer);
  const ExrPart& part = partOf(file, beauty.part);
  refuseEnvironmentMaps(part, file.document.path);
  if (part.levelMode != 0)
    throw InputError(fmt::format("{}: found a {} map, expected one level: convert it first", file.document.path,
                                 part.levelMode == 1 ? "mip" : "rip"));
  const NamedChannel& depth = options.depthFile
                                  ? depthBeside(file.document, all, *options.depthFile)
                                  : resolveDepth(file.document, channels, beauty, options.depthChannel, producer);

  GBuffer& gbuffer = file.gbuffer;
  gbuffer.display = part.display;
  gbuffer.data = part.data;
  gbuffer.pixelAspect = part.pixelAspect;
  gbuffer.hasAlpha = beauty.channel[3] != nullptr;
  file.choice.beautyPart = beauty.part;
  file.choice.depthPart = depth.part;
  file.choice.depthChannel = depth.channel->name;
  file.choice.depthFile = partOf(file, depth.part).from;
  file.choice.preset = producer ? producer->name : "";
  file.choice.presetBy = recognised.by;
  readPixelFilter(part, producer, file);
  file.metresPerUnit = options.metresPerUnit.value_or(producer ? producer->unit : 1.0);
  if (!beauty.view.empty() && options.beautyLayer.empty() && options.view.empty())
    file.notes.push_back(fmt::format("view {} is used; --view names another", beauty.view));
  readCamera(part, file.metresPerUnit, file);
  file.space = statedSpace(part, producer ? producer->space : "", file.notes);
  if (options.framingAlone) return file;
  readBeauty(beauty, file);
  if (!camera && gbuffer.camera) camera = &*gbuffer.camera;
  const ExrPart& depthPart = partOf(file, depth.part);
  noteRounded(depthPart, *depth.channel, file);
  convertDepth(depthPart, *depth.channel, kindOf(options, producer, all, depth), !options.depthKind.empty(), producer,
               options.farValue, camera, file);
  readOtherPasses(all, beauty, producer, file);
  gbuffer.objects = ObjectCoverage::of(file.document, channels, beauty.view, gbuffer.data);
  return file;
}

OpaqueFile readOpaque(const std::string& path, const ReadOptions& options, const Camera* camera) {
  checkOptions(options);
  return interpretOpaque(readWithSides(path, options), options, camera);
}

}  // namespace pellucid
