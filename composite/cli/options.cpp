#include "composite/cli/options.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>

#include "composite/cli/budget.h"
#include "engine_bridge/scene/set_keys.h"
#include "gbuffer/errors.h"

namespace pellucid::cli {
namespace {

std::vector<double> parseNumbers(const std::string& text, char separator, std::size_t count, const std::string& flag,
                                 const std::string& form) {
  std::vector<double> numbers;
  const char* at = text.data();
  const char* end = text.data() + text.size();
  while (at <= end) {
    double value = 0;
    const auto [next, error] = std::from_chars(at, end, value);
    if (error != std::errc() || !std::isfinite(value)) break;
    numbers.push_back(value);
    if (next == end && numbers.size() == count) return numbers;
    if (next == end || *next != separator) break;
    at = next + 1;
  }
  throw UsageError(fmt::format("{}: found '{}', expected {}", flag, text, form));
}

SubmissionOrder parseOrder(const std::string& text) {
  SubmissionOrder order;
  if (text == "file") return order;
  if (text == "reverse") {
    order.kind = SubmissionOrder::reverse;
    return order;
  }
  const std::string key = "shuffle:";
  if (text.rfind(key, 0) == 0 && text.size() > key.size()) {
    order.kind = SubmissionOrder::shuffle;
    const auto [next, error] = std::from_chars(text.data() + key.size(), text.data() + text.size(), order.seed);
    if (error == std::errc() && next == text.data() + text.size()) return order;
  }
  throw UsageError(fmt::format("--order: found '{}', expected file, reverse or shuffle:SEED", text));
}

}  // namespace

std::size_t parseBytes(const std::string& text, const std::string& flag) {
  std::size_t value = 0;
  const auto [next, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const std::string unit(next, text.data() + text.size());
  const int shift = unit.empty() ? 0 : unit == "K" ? 10 : unit == "M" ? 20 : unit == "G" ? 30 : -1;
  if (error != std::errc() || shift < 0 || value == 0 || value > (SIZE_MAX >> shift))
    throw UsageError(fmt::format("{}: found '{}', expected bytes such as 64M or 2G", flag, text));
  return value << shift;
}

bool isColour(const std::string& text) {
  return text.find(',') != std::string::npos && text.find_first_not_of("0123456789+-.eE,") == std::string::npos;
}

glm::vec3 parseColour(const std::string& text, const std::string& flag) {
  const auto numbers = parseNumbers(text, ',', 3, flag, "three numbers R,G,B");
  for (const double number : numbers)
    if (number < 0) throw UsageError(fmt::format("{}: found '{}', expected no negative light", flag, text));
  return glm::vec3(static_cast<float>(numbers[0]), static_cast<float>(numbers[1]), static_cast<float>(numbers[2]));
}

std::pair<double, double> parseRange(const std::string& text, const std::string& flag) {
  const auto numbers = parseNumbers(text, ':', 2, flag, "NEAR:FAR in metres");
  if (numbers[0] <= 0 || numbers[1] <= numbers[0])
    throw UsageError(fmt::format("{}: found '{}', expected 0 < NEAR < FAR", flag, text));
  return {numbers[0], numbers[1]};
}

void SceneFlags::addTo(CLI::App& verb) {
  verb.add_option(
          "--camera", cameras,
          "glTF camera by name, or eye=X,Y,Z;look=X,Y,Z;up=X,Y,Z;fov=DEGREES (vertical); VIEW=CAMERA is that of "
          "one view")
      ->allow_extra_args(false);
  verb.add_option("--environment", environment,
                  "Surroundings: radiance R,G,B or a lat-long EXR; without it the sky's median");
  verb.add_option("--set", overrides, "MATERIAL.key=value: " + gltf::setKeyNames())->allow_extra_args(false);
  verb.add_option("--scene-unit", unit, "Metres in one unit of the glTF, of fog and its grids; --unit is the picture's")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  verb.add_option("--asset-root", assetRoot, "Folder whose files a glTF may name besides those under its own folder");
  verb.add_option("--lumens-per-watt", lumensPerWatt, "glTF lights are photometric, renders are not")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  verb.add_option("--texture-filter", textureFilter, "How textures are read where a texel is not a pixel")
      ->check(CLI::IsMember({"mipmap", "bilinear", "nearest"}))
      ->capture_default_str();
  verb.add_option("--mask", mask,
                  "Of alpha-tested materials; smooth: rims are partly covered, and patterns finer than a sample show "
                  "their mean; hard: tested at the sample alone")
      ->check(CLI::IsMember({"smooth", "hard"}))
      ->capture_default_str();
  verb.add_option("--order", order, "Submission order: file, reverse or shuffle:SEED")->capture_default_str();
  verb.add_option("--budget", budget,
                  "Geometry resident at once, in bytes (64M, 2G; at least 1M): chunks, their GL buffers and pages of "
                  "the files. "
                  "--shadows exact decodes all triangles besides")
      ->capture_default_str();
  verb.add_option("--device", device, "EGL device by number, see inspect --devices");
  colour.addTo(
      verb,
      "Linear space of the picture's colours, into which those of the glTF are brought; auto goes by the EXR's "
      "chromaticities, the config's rules for files, the preset, and else takes linear Rec.709");
}

namespace {

glm::dvec3 parsePoint(const std::string& text) {
  const auto numbers = parseNumbers(text, ',', 3, "--camera", "three numbers X,Y,Z");
  return {numbers[0], numbers[1], numbers[2]};
}

// Pages of the files: more would only keep what has been drawn.
std::size_t pageBytes(std::size_t budget) {
  constexpr std::size_t kShare = 4, kMost = std::size_t{16} << 20;
  return std::min(budget / kShare, kMost);
}

}  // namespace

CameraChoice cameraChoice(const std::string& text) {
  if (text.empty()) return std::monostate();
  if (text.find('=') == std::string::npos) return NamedCamera{text};
  PlacedCamera camera;
  std::istringstream parts(text);
  for (std::string part; std::getline(parts, part, ';');) {
    const auto equals = part.find('=');
    const std::string key = part.substr(0, equals);
    const std::string value = equals == std::string::npos ? "" : part.substr(equals + 1);
    if (key == "eye")
      camera.eye = parsePoint(value);
    else if (key == "look")
      camera.look = parsePoint(value);
    else if (key == "up")
      camera.up = parsePoint(value);
    else if (key == "fov")
      camera.fov = parseNumbers(value, ',', 1, "--camera", "fov=DEGREES")[0];
    else
      throw UsageError(fmt::format("--camera: found '{}', expected eye=, look=, up= or fov=", part));
  }
  if (!(camera.fov > 0 && camera.fov < 180))
    throw UsageError(fmt::format("--camera: found fov={}, expected degrees between 0 and 180", camera.fov));
  if (glm::length(glm::cross(camera.look - camera.eye, camera.up)) < 1e-12)
    throw UsageError("--camera: the view direction and up are parallel, expected two directions");
  return camera;
}

CameraChoice cameraOfView(const std::vector<std::string>& cameras, const std::string& view,
                          const std::vector<std::string>& views) {
  std::string general, own;
  for (const std::string& text : cameras) {
    const std::string key = text.substr(0, text.find('='));
    const bool placed = key == "eye" || key == "look" || key == "up" || key == "fov";
    const bool ofView = key.size() < text.size() && !placed;
    if (ofView && std::find(views.begin(), views.end(), key) == views.end())
      throw UsageError(
          fmt::format("--camera: found '{}', expected a glTF camera, eye=, look=, up= or fov=, or a view "
                      "that --view names before the equals sign",
                      text));
    if (ofView && key != view) continue;
    std::string& choice = ofView ? own : general;
    if (!choice.empty())
      throw UsageError(
          fmt::format("--camera: found '{}' and '{}', expected one, or VIEW=CAMERA for each view", choice, text));
    choice = ofView ? text.substr(key.size() + 1) : text;
  }
  return cameraChoice(own.empty() ? general : own);
}

SurroundingsChoice surroundingsChoice(const std::string& text) {
  if (text.empty()) return std::monostate();
  if (isColour(text)) return parseColour(text, "--environment");
  return PictureOfSurroundings{text};
}

void SceneFlags::into(Request& request) const {
  const std::size_t bytes = parseBudget(budget), pages = pageBytes(bytes);
  SceneOptions& scene = request.shot.scene;
  scene.metresPerUnit = unit;
  scene.lumensPerWatt = lumensPerWatt;
  scene.overrides = overrides;
  scene.assetRoot = assetRoot;
  scene.streamBytes = pages;
  const std::string& view = request.shot.read.view;
  request.shot.camera = cameraOfView(cameras, view, {view});
  request.shot.surroundings = surroundingsChoice(environment);
  request.filter = textureFilter == "mipmap"     ? TextureFilter::mipmap
                   : textureFilter == "bilinear" ? TextureFilter::bilinear
                                                 : TextureFilter::nearest;
  request.mask = mask == "smooth" ? MaskEdge::smooth : MaskEdge::hard;
  request.residency.order = parseOrder(order);
  request.residency.budgetBytes = bytes - pages;
  request.device = device;
  request.shot.colour = colour.request();
}

void RunFlags::addTo(CLI::App& verb) {
  verb.add_option("--threads", threads, "0 uses every core")->check(CLI::NonNegativeNumber);
  verb.add_flag("--stats", stats, "Print counts and the time of every stage");
  verb.add_flag("--json", json, "Print results as JSON");
}

}  // namespace pellucid::cli
