#include "composite/cli/camera_flag.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "composite/cli/parse.h"
#include "gbuffer/deep_channels.h"
#include "gbuffer/errors.h"

namespace pellucid::cli {
namespace {

constexpr double kFarthest = 1e15;  // as in a glTF

glm::dvec3 parsePoint(const std::string& text) {
  const auto numbers = parseNumbers(text, ',', 3, "--camera", "three numbers X,Y,Z");
  for (const double number : numbers)
    if (!(std::abs(number) <= kFarthest))
      throw UsageError(fmt::format("--camera: found {:g}, expected magnitudes up to {:g}", number, kFarthest));
  return {numbers[0], numbers[1], numbers[2]};
}

// "fit" or "fit:AZIMUTH,ELEVATION"
FittedCamera fitted(const std::string& text) {
  FittedCamera camera;
  if (text == "fit") return camera;
  const auto angles = parseNumbers(text.substr(4), ',', 2, "--camera", "fit:AZIMUTH,ELEVATION in degrees");
  camera.azimuth = angles[0];
  camera.elevation = angles[1];
  if (!(std::abs(camera.elevation) <= 90.0))
    throw UsageError(
        fmt::format("--camera: found fit with the elevation {}, expected degrees from -90 to 90", camera.elevation));
  return camera;
}

}  // namespace

CameraChoice cameraChoice(const std::string& text) {
  if (text.empty()) return std::monostate();
  if (text == "fit" || text.rfind("fit:", 0) == 0) return fitted(text);
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

std::vector<std::string> viewsOf(const std::string& path) {
  const ExrDocument document = readExr(path);
  if (isDeep(document))
    throw UsageError(fmt::format("{}: --view: found all with a deep picture, expected one view of it", path));
  if (document.views.size() < 2)
    throw MeaningError(fmt::format("{}: --view: found {}, expected several views for all", path,
                                   document.views.empty() ? "no views" : "the view " + document.views[0]));
  return document.views;
}

}  // namespace pellucid::cli
