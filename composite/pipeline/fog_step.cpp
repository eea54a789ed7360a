#include "composite/pipeline/fog_step.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "engine_bridge/scene/ambient.h"
#include "engine_bridge/scene/density_grid.h"
#include "gbuffer/errors.h"

namespace pellucid {

const char* const kFogKeys =
    "density, height, base, albedo (one number or R:G:B), g, far, steps, shafts, order (ordered or sums), box "
    "(X:Y:Z:X:Y:Z), up (y or z, of the grid)";

namespace {

constexpr double kMost = 1e9;

std::vector<double> numbersOf(const std::string& key, const std::string& text) {
  std::vector<double> numbers;
  std::size_t begin = 0;
  while (begin <= text.size()) {
    const std::size_t end = std::min(text.find(':', begin), text.size());
    double value = 0.0;
    const auto [stopped, problem] = std::from_chars(text.data() + begin, text.data() + end, value);
    if (problem != std::errc() || stopped != text.data() + end || !std::isfinite(value))
      throw UsageError(fmt::format("--fog: found {}={}, expected numbers", key, text));
    numbers.push_back(value);
    begin = end + 1;
  }
  return numbers;
}

double within(const std::string& key, const std::string& text, double least, double most) {
  const std::vector<double> numbers = numbersOf(key, text);
  if (numbers.size() != 1 || !(numbers[0] >= least && numbers[0] <= most))
    throw UsageError(fmt::format("--fog: found {}={}, expected a number from {:g} to {:g}", key, text, least, most));
  return numbers[0];
}

int whole(const std::string& key, const std::string& text, int least, int most) {
  const double value = within(key, text, least, most);
  if (value != std::floor(value))
    throw UsageError(fmt::format("--fog: found {}={}, expected a whole number", key, text));
  return static_cast<int>(value);
}

void setKey(FogText& fog, const std::string& key, const std::string& text) {
  MediumSettings& medium = fog.medium;
  if (key == "density") {
    medium.density = within(key, text, 0.0, kMost);
    fog.hasDensity = true;
  } else if (key == "height") {
    medium.height = within(key, text, 1e-3, kMost);
  } else if (key == "base") {
    medium.base = within(key, text, -kMost, kMost);
  } else if (key == "albedo") {
    const std::vector<double> numbers = numbersOf(key, text);
    if (numbers.size() != 1 && numbers.size() != 3)
      throw UsageError(fmt::format("--fog: found albedo={}, expected one number or three", text));
    for (int c = 0; c < 3; ++c) {
      medium.albedo[c] = numbers[numbers.size() == 1 ? 0 : static_cast<std::size_t>(c)];
      if (!(medium.albedo[c] >= 0.0 && medium.albedo[c] <= 1.0))
        throw UsageError(fmt::format("--fog: found albedo={}, expected numbers from 0 to 1", text));
    }
  } else if (key == "g") {
    medium.g = within(key, text, -0.98, 0.98);
  } else if (key == "far") {
    medium.farthest = within(key, text, 1e-3, kMost);
  } else if (key == "steps") {
    medium.steps = whole(key, text, 1, 4096);
  } else if (key == "shafts") {
    fog.shafts = whole(key, text, 0, 512);
  } else if (key == "order") {
    if (text != "ordered" && text != "sums")
      throw UsageError(fmt::format("--fog: found order={}, expected ordered or sums", text));
    medium.order = text == "sums" ? shading::PLD_FOG_SUMS : shading::PLD_FOG_ORDERED;
  } else if (key == "box") {
    const std::vector<double> n = numbersOf(key, text);
    if (n.size() != 6 || !(n[3] > n[0] && n[4] > n[1] && n[5] > n[2]))
      throw UsageError(
          fmt::format("--fog: found box={}, expected X:Y:Z of its low corner, then of its high one", text));
    for (const double value : n) within("box", fmt::format("{}", value), -kMost, kMost);
    medium.box = Box{{n[0], n[1], n[2]}, {n[3], n[4], n[5]}};
  } else if (key == "up") {
    if (text != "y" && text != "z") throw UsageError(fmt::format("--fog: found up={}, expected y or z", text));
    fog.zUp = text == "z";
  } else {
    throw UsageError(fmt::format("--fog: found the key '{}', expected one of {}", key, kFogKeys));
  }
}

// 0.5, "sums", [1, 2, 3]: as the list would have it.
std::string textOf(const nlohmann::json& value) {
  if (value.is_string()) return value.get<std::string>();
  if (value.is_number()) return value.dump();
  std::string text;
  if (value.is_array())
    for (const nlohmann::json& each : value) text += (text.empty() ? "" : ":") + (each.is_number() ? each.dump() : "?");
  return text.empty() ? "?" : text;
}

}  // namespace

FogText readFogText(const std::string& text) {
  FogText fog;
  std::istringstream parts(text);
  for (std::string part; std::getline(parts, part, ',');) {
    const auto equals = part.find('=');
    if (equals == std::string::npos)
      throw UsageError(fmt::format("--fog: found '{}', expected key=value or FILE.json", part));
    setKey(fog, part.substr(0, equals), part.substr(equals + 1));
  }
  return fog;
}

FogText readFogFile(const std::string& path) {
  FogText fog;
  std::error_code problem;
  const auto bytes = std::filesystem::file_size(path, problem);
  if (problem || !std::filesystem::is_regular_file(path))
    throw InputError(fmt::format("{}: no such file, expected JSON of a fog", path));
  if (bytes > 65536) throw InputError(fmt::format("{}: found {} bytes, expected at most 65536", path, bytes));
  std::ifstream in(path, std::ios::binary);
  const nlohmann::json json = nlohmann::json::parse(in, nullptr, false);
  if (!json.is_object()) throw InputError(fmt::format("{}: damaged, or not JSON: expected one object", path));
  for (const auto& [key, value] : json.items()) {
    try {
      setKey(fog, key, textOf(value));
    } catch (const UsageError& error) {
      throw InputError(fmt::format("{}: {}", path, std::string(error.what()).substr(7)));
    }
  }
  return fog;
}

void checkFog(const FogText& text, bool hasGrid) {
  if (hasGrid && (text.medium.box || text.medium.height > 0.0))
    throw UsageError("--fog-grid: found height or box beside it, expected a grid that says itself where it is");
  if (text.medium.density == 0.0 && (text.hasDensity || !hasGrid))
    throw UsageError("--fog: found a density of 0, expected density=D, the extinction of a metre");
}

PlacedFog placeFogOf(const FogRequest& request, const Shot& shot, double metresPerUnit, Journal& journal) {
  if (!request.on()) return {};
  if (!shot.hasCamera)
    throw MeaningError(
        fmt::format("{}: no camera: found deep files alone and no worldToCamera, expected --camera eye=...: fog is "
                    "marched along rays",
                    shot.opaque.document.path));
  FogText text = request.text ? *request.text : request.file.empty() ? FogText() : readFogFile(request.file);
  const bool hasGrid = !request.grid.empty();
  checkFog(text, hasGrid);
  MediumSettings& medium = text.medium;
  if (hasGrid) {
    if (!text.hasDensity) medium.density = 1.0;
    GridOptions options;
    options.metresPerUnit = metresPerUnit;
    options.zUp = text.zUp;
    if (!request.gridName.empty()) options.name = request.gridName;
    std::vector<std::string> notes;
    medium.grid = journal.time("read grid", [&] { return readDensityGrid(request.grid, options, notes); });
    journal.note(notes);
  }
  AmbientLight ambient{shot.surroundings, {}};
  if (shot.environment) ambient = ambientOf(*shot.environment);
  Fog placed = placeFog(medium, shot.camera, ambient, lightBlocks(shot.scene.lights, shot.camera));
  return {std::make_shared<const Fog>(std::move(placed)), medium, text.shafts};
}

std::shared_ptr<const Fog> lightFog(const PlacedFog& placed, const Shot& shot, Air& air, Journal& journal) {
  if (!placed.fog || placed.fog->lights.empty()) return placed.fog;
  // What the grid itself leaves of the lights belongs to the grid, not to shafts.
  constexpr int kGridTexels = 96;
  if (placed.shafts == 0 && !placed.medium.grid) return placed.fog;
  auto lit = std::make_shared<Fog>(*placed.fog);
  const Box bounds = fogBounds(placed.medium, shot.camera, shot.opaque.gbuffer);
  lit->visibility = journal.time("light in fog", [&] {
    return placed.shafts > 0 ? sampleLights(*placed.fog, bounds, placed.shafts, air.surfacesAndParticles())
                             : sampleLights(*placed.fog, bounds, kGridTexels, nullptr);
  });
  return lit;
}

}  // namespace pellucid
