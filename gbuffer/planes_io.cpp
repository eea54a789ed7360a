#include "gbuffer/planes_io.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <sstream>
#include <stdexcept>

#include "gbuffer/errors.h"
#include "gbuffer/exr_document.h"
#include "gbuffer/plane_values.h"
#include "gbuffer/published.h"

namespace pellucid {
namespace {

// Numbers as text that reads back to the same bits.
class NumberText {
 public:
  void add(double value) { text += fmt::format("{}{:.17g}", text.empty() ? "" : " ", value); }
  std::string text;
};

std::string cameraText(const Camera& camera) {
  NumberText numbers;
  for (int c = 0; c < 4; ++c)
    for (int r = 0; r < 4; ++r) numbers.add(camera.viewFromWorld[c][r]);
  for (const double value : {camera.orthographic ? 1.0 : 0.0, camera.focal.x, camera.focal.y, camera.centre.x,
                             camera.centre.y, camera.rangeNear, camera.rangeFar})
    numbers.add(value);
  return numbers.text;
}

class HeaderReader {
 public:
  HeaderReader(const ExrPart& part, const std::string& path) : part_(part), path_(path) {}

  std::string text(const char* name) const {
    const std::optional<std::string> value = part_.text(name);
    if (!value)
      throw MeaningError(
          fmt::format("{}: not OIT planes: found no attribute {}, expected what accumulate writes", path_, name));
    return *value;
  }
  std::vector<double> numbers(const char* name, std::size_t count, const std::string& from) const {
    std::istringstream in(from);
    std::vector<double> values;
    for (std::string word; in >> word;) {
      char* end = nullptr;
      values.push_back(std::strtod(word.c_str(), &end));
      if (*end || !std::isfinite(values.back())) refuse(name, from);
    }
    if (values.size() != count) refuse(name, from);
    return values;
  }
  const ExrPart& part() const { return part_; }
  ColourSpace space() const { return readSpace(part_, path_); }
  [[noreturn]] void refuse(const char* name, const std::string& found) const {
    throw MeaningError(
        fmt::format("{}: attribute {}: found '{}', expected what accumulate writes", path_, name, found));
  }

 private:
  const ExrPart& part_;
  const std::string& path_;
};

// Of the planes' own camera, and of the one that took the picture.
struct CameraAttributes {
  const char *numbers, *origin;
};
constexpr CameraAttributes kCamera{"pellucid:camera", "pellucid:cameraOrigin"},
    kPictureCamera{"pellucid:pictureCamera", "pellucid:pictureCameraOrigin"};

Camera cameraOf(const HeaderReader& header, const CameraAttributes& names = kCamera) {
  const std::vector<double> n = header.numbers(names.numbers, 23, header.text(names.numbers));
  Camera camera;
  for (int c = 0; c < 4; ++c)
    for (int r = 0; r < 4; ++r) camera.viewFromWorld[c][r] = n[static_cast<std::size_t>(c * 4 + r)];
  camera.orthographic = n[16] != 0.0;
  camera.focal = {n[17], n[18]};
  camera.centre = {n[19], n[20]};
  camera.rangeNear = n[21];
  camera.rangeFar = n[22];
  camera.origin = header.text(names.origin);
  return camera;
}

OitInfo infoOf(const HeaderReader& header) {
  OitInfo info;
  info.method = header.text("pellucid:method");
  info.tier = header.text("pellucid:tier");
  info.solidHash = header.text("pellucid:solidHash");
  info.places = header.part().text("pellucid:places").value_or("");
  const std::string normalisation = header.text("pellucid:normalisation");
  if (normalisation != "spectral" && normalisation != "published")
    header.refuse("pellucid:normalisation", normalisation);
  info.normalisation = normalisation == "spectral" ? shading::PLD_NORMALISE_SPECTRAL : shading::PLD_NORMALISE_PUBLISHED;
  const std::string weight = header.text("pellucid:weight");
  const std::optional<shading::WeightSettings> known = readWeightText(weight);
  if (!known) header.refuse("pellucid:weight", weight);
  info.weight = *known;
  info.space = header.space();
  return info;
}

template <class Put>
void readPlane(const ExrPart& part, const char* name, bool finite, const std::string& path, Put put) {
  const ExrChannel* channel = part.find(name);
  if (!channel) throw MeaningError(fmt::format("{}: no plane {}, expected all that accumulate writes", path, name));
  if (channel->type != PixelType::float32)
    throw MeaningError(fmt::format("{}: plane {}: found {}, expected float", path, name, nameOf(channel->type)));
  const std::size_t pixels = channel->bytes.size() / sizeof(float);
  const auto width = static_cast<std::size_t>(part.data.width());
  for (std::size_t i = 0; i < pixels; ++i) {
    float value = 0;
    std::memcpy(&value, channel->bytes.data() + i * sizeof value, sizeof value);
    if (finite ? !std::isfinite(value) : !(value > 0.0f))
      throw InputError(fmt::format("{}: plane {}: found {} at pixel ({}, {}), expected {}", path, name, value,
                                   part.data.x0 + static_cast<int>(i % width),
                                   part.data.y0 + static_cast<int>(i / width),
                                   finite ? "a finite sum" : "a distance above 0"));
    put(i, value);
  }
}

// Where a channel's numbers lie in memory.
template <class Planes, class Rims>
auto channelValues(Planes& planes, Rims& rims, const PlaneChannel& channel) {
  const auto values = valuesOf(planes, channel.sum, channel.component);
  return values ? values : valuesOf(rims, channel.sum, channel.component);
}

// Whether a file has any of a group's channels, and so must have all.
bool hasGroup(const ExrPart& part, ChannelGroup group, bool published, const std::string& path) {
  if (group == ChannelGroup::sums) return true;
  const auto firstOf = [&](const std::vector<PlaneChannel>& channels) {
    return std::find_if(channels.begin(), channels.end(),
                        [&](const PlaneChannel& channel) { return part.find(channel.name) != nullptr; });
  };
  const std::vector<PlaneChannel>&channels = channelsOf(group, published), &any = channelsOf(group, false);
  const auto stray = firstOf(any);
  if (channels.empty() && stray != any.end())
    throw InputError(fmt::format("{}: found {} in tier published, expected no such plane", path, stray->name));
  return firstOf(channels) != channels.end();
}

NewExr fileOf(const OitPlanes& planes, const RimPlanes& rims) {
  NewExr file;
  file.display = planes.display;
  file.data = planes.data;
  const auto pixels = static_cast<std::size_t>(planes.data.width()) * static_cast<std::size_t>(planes.data.height());
  const auto addChannel = [&](const char* name, auto value) {
    ExrChannel channel{name, PixelType::float32, std::vector<std::byte>(pixels * sizeof(float))};
    for (std::size_t i = 0; i < pixels; ++i) {
      const float number = value(i);
      std::memcpy(channel.bytes.data() + i * sizeof number, &number, sizeof number);
    }
    file.channels.push_back(std::move(channel));
  };
  for (const ChannelGroup group : kChannelGroups) {
    const std::vector<PlaneChannel>& channels = channelsOf(group, planes.published());
    if (channels.empty() || !channelValues(planes, rims, channels.front())) continue;
    for (const PlaneChannel& channel : channels) {
      const ConstPlaneValues values = channelValues(planes, rims, channel);
      addChannel(channel.name, [values](std::size_t i) { return values[i]; });
    }
  }

  file.attributes = {
      {"pellucid:method", planes.info.method},
      {"pellucid:weight", weightText(planes.info.weight)},
      {"pellucid:normalisation",
       planes.info.normalisation == shading::PLD_NORMALISE_SPECTRAL ? "spectral" : "published"},
      {"pellucid:tier", planes.info.tier},
      {"pellucid:solidHash", planes.info.solidHash},
      {kCamera.numbers, cameraText(planes.camera)},
      {kCamera.origin, planes.camera.origin},
  };
  if (!planes.info.places.empty()) file.attributes["pellucid:places"] = planes.info.places;
  putSpace(planes.info.space, file.attributes);
  file.chromaticities = chromaticitiesToWrite(planes.info.space);
  float matrices[2][4][4];
  cameraToExr(planes.camera, matrices[0], matrices[1]);
  file.matrices["worldToCamera"].assign(&matrices[0][0][0], &matrices[0][0][0] + 16);
  file.matrices["worldToNDC"].assign(&matrices[1][0][0], &matrices[1][0][0] + 16);
  return file;
}

OitPlanes planesOf(const ExrPart& part, const std::string& path, RimPlanes* rims) {
  if (part.deep) throw MeaningError(path + ": not OIT planes: found deep samples, expected what accumulate writes");
  const HeaderReader header(part, path);
  const OitInfo info = infoOf(header);
  const Camera camera = cameraOf(header);
  const bool published = info.tier == "published";
  OitPlanes planes = published ? emptyPublishedPlanes(part.display, part.data) : emptyPlanes(part.display, part.data);
  planes.info = info;
  planes.camera = camera;
  RimPlanes found;
  for (const ChannelGroup group : kChannelGroups) {
    if (!hasGroup(part, group, published, path)) continue;
    if (group == ChannelGroup::rims) found = RimPlanes(part.data.width(), part.data.height());
    for (const PlaneChannel& channel : channelsOf(group, published)) {
      addPlane(planes, channel.sum);
      const PlaneValues values = channelValues(planes, found, channel);
      readPlane(part, channel.name, channel.finite, path, [values](std::size_t i, float value) { values[i] = value; });
    }
  }
  if (!found.empty() && !rims) throw std::logic_error(path + ": its rims wait for their occlusion, which nobody takes");
  if (!found.empty()) *rims = std::move(found);
  if (published)
    for (int y = 0; y < planes.data.height(); ++y)
      for (int x = 0; x < planes.data.width(); ++x) completePublished(planes, x, y);
  return planes;
}

constexpr const char *kPass = "pellucid:pass", *kEdges = "pellucid:edges";
constexpr const char* kScatter = ", what scatters";  // after the pass, of a part with PassPlanes::scatter

bool isScatter(const ExrPart& part) {
  const std::string text = part.text(kPass).value_or(""), end = kScatter;
  return text.size() > end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

// Channels of a picture's colours; all of them or none.
using ColourNames = std::vector<const char*>;
// The beauty as shadows leave it, and where; and as it is lit in one pass.
const ColourNames kRelit{"oit.relit.R", "oit.relit.G", "oit.relit.B", "oit.relit.changed"};
const ColourNames kNow{"oit.now.R", "oit.now.G", "oit.now.B"};
// What a multiplier for the whole beauty would be.
const ColourNames kShadow{"oit.shadow.R", "oit.shadow.G", "oit.shadow.B"};

template <class Colour>
void addColours(const Image<Colour>& colours, const ColourNames& names, NewExr& file) {
  if (colours.empty()) return;
  for (std::size_t c = 0; c < names.size(); ++c) {
    ExrChannel channel{names[c], PixelType::float32, std::vector<std::byte>(colours.size() * sizeof(float))};
    for (std::size_t i = 0; i < colours.size(); ++i)
      std::memcpy(channel.bytes.data() + i * sizeof(float), &colours[i][static_cast<int>(c)], sizeof(float));
    file.channels.push_back(std::move(channel));
  }
}

template <class Colour>
Image<Colour> coloursOf(const ExrPart& part, const ColourNames& names, const std::string& path) {
  Image<Colour> colours;
  if (!part.find(names[0])) return colours;
  colours = Image<Colour>(part.data.width(), part.data.height(), Colour(0.0f));
  for (std::size_t c = 0; c < names.size(); ++c) {
    const ExrChannel* channel = part.find(names[c]);
    if (!channel || channel->type != PixelType::float32)
      throw MeaningError(
          fmt::format("{}: {}: found no such float plane, expected all that accumulate writes", path, names[c]));
    for (std::size_t i = 0; i < colours.size(); ++i) colours[i][static_cast<int>(c)] = channel->at(i);
  }
  return colours;
}

std::optional<Camera> pictureCameraOf(const ExrPart& part, const std::string& path) {
  if (!part.text(kPictureCamera.numbers)) return std::nullopt;
  return cameraOf(HeaderReader(part, path), kPictureCamera);
}

NewExr fileOf(const PassPlanes& pass) {
  NewExr file = fileOf(pass.planes, pass.rims);
  addColours(pass.relit, kRelit, file);
  addColours(pass.now, kNow, file);
  addColours(pass.shadow, kShadow, file);
  if (pass.pictureCamera) {
    file.attributes[kPictureCamera.numbers] = cameraText(*pass.pictureCamera);
    file.attributes[kPictureCamera.origin] = pass.pictureCamera->origin;
  }
  file.attributes[kEdges] = pass.edges ? "resolve" : "off";
  if (!pass.pixelFilter.isPixelSquare()) file.attributes[kFilterAttribute] = filterText(pass.pixelFilter);
  return file;
}

PixelFilter filterOf(const ExrPart& part, const std::string& path) {
  const std::optional<std::string> text = part.text(kFilterAttribute);
  const std::optional<PixelFilter> filter = text ? pixelFilterOf(*text) : PixelFilter();
  if (!filter)
    throw MeaningError(
        fmt::format("{}: {}: found '{}', expected a filter as --filter takes it", path, kFilterAttribute, *text));
  return *filter;
}

std::string passText(std::size_t index, std::size_t count) {
  return fmt::format("{} of {}", index + 1, count);
}

}  // namespace

void writePlanes(const std::string& path, const OitPlanes& planes, const RimPlanes& rims) {
  writeNewExr(path, fileOf(planes, rims));
}

OitPlanes readPlanes(const std::string& path, RimPlanes* rims) {
  const ExrDocument document = readExr(path);
  if (document.parts.size() > 1)
    throw MeaningError(fmt::format("{}: found {} parts, expected the planes of one pass", path, document.parts.size()));
  return planesOf(document.parts[0], path, rims);
}

void writePasses(const std::string& path, const std::vector<PassPlanes>& passes,
                 const std::map<std::string, std::string>& attributes) {
  if (passes.size() == 1 && !passes[0].scatter.scatters()) {
    NewExr file = fileOf(passes[0]);
    file.attributes.insert(attributes.begin(), attributes.end());
    writeNewExr(path, file);
    return;
  }
  std::vector<NewExr> parts;
  for (std::size_t i = 0; i < passes.size(); ++i) {
    parts.push_back(fileOf(passes[i]));
    parts.back().part = fmt::format("pass{:04d}", i + 1);
    parts.back().attributes[kPass] = passText(i, passes.size());
    if (!passes[i].scatter.scatters()) continue;
    parts.push_back(fileOf(passes[i].scatter, {}));
    parts.back().part = fmt::format("pass{:04d}.scatter", i + 1);
    parts.back().attributes[kPass] = passText(i, passes.size()) + kScatter;
  }
  parts.front().attributes.insert(attributes.begin(), attributes.end());
  writeNewExr(path, parts);
}

std::vector<PassPlanes> readPasses(const std::string& path) {
  const ExrDocument document = readExr(path);
  std::vector<PassPlanes> passes;
  const auto count = static_cast<std::size_t>(std::count_if(document.parts.begin(), document.parts.end(),
                                                            [](const ExrPart& part) { return !isScatter(part); }));
  for (std::size_t i = 0; i < document.parts.size(); ++i) {
    const ExrPart& part = document.parts[i];
    const bool scatter = isScatter(part) && !passes.empty();
    const std::string expected =
        scatter ? passText(passes.size() - 1, count) + kScatter : passText(passes.size(), count);
    const std::string found = part.text(kPass).value_or(passText(0, 1));
    if (found != expected)
      throw MeaningError(fmt::format("{}: part {}: found pass {}, expected {}: all passes of one picture, in order",
                                     path, i, found, expected));
    if (scatter) {
      passes.back().scatter = planesOf(part, path, nullptr);
      continue;
    }
    PassPlanes pass;
    pass.planes = planesOf(part, path, &pass.rims);
    pass.relit = coloursOf<glm::vec4>(part, kRelit, path);
    pass.now = coloursOf<glm::vec4>(part, kNow, path);
    pass.shadow = coloursOf<glm::vec3>(part, kShadow, path);
    pass.pictureCamera = pictureCameraOf(part, path);
    pass.edges = part.text(kEdges).value_or("off") == "resolve";
    pass.pixelFilter = filterOf(part, path);
    if (!passes.empty() && pass.planes.data != passes[0].planes.data)
      throw MeaningError(
          fmt::format("{}: part {}: found another data window than the first part's, expected the same", path, i));
    passes.push_back(std::move(pass));
  }
  return passes;
}

}  // namespace pellucid
