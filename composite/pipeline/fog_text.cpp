#include "composite/pipeline/fog_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "engine_bridge/scene/blackbody.h"
#include "gbuffer/errors.h"

namespace pellucid {

const char* const kFogKeys =
    "density, height, base, albedo (one number or R:G:B), g, emission (one number or R:G:B: radiance that a metre adds "
    "where the fog is as dense as density=D says, or an emission grid is 1), blackbody (absorption per metre of what a "
    "temperature grid makes glow), kelvin (that a value of 1 of it stands for), far, steps, shafts, order (ordered or "
    "sums), collimation (0 to 1 (1); below 1 it diffuses what lies behind it, as materials do), box (X:Y:Z:X:Y:Z), up "
    "(y "
    "or z, of the grids)";

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

glm::dvec3 colour(const std::string& key, const std::string& text, double most) {
  const std::vector<double> numbers = numbersOf(key, text);
  if (numbers.size() != 1 && numbers.size() != 3)
    throw UsageError(fmt::format("--fog: found {}={}, expected one number or three", key, text));
  for (const double number : numbers)
    if (!(number >= 0.0 && number <= most))
      throw UsageError(fmt::format("--fog: found {}={}, expected numbers from 0 to {:g}", key, text, most));
  return numbers.size() == 1 ? glm::dvec3(numbers[0]) : glm::dvec3(numbers[0], numbers[1], numbers[2]);
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
    medium.albedo = colour(key, text, 1.0);
  } else if (key == "g") {
    medium.g = within(key, text, -0.98, 0.98);
  } else if (key == "collimation") {
    medium.collimation = within(key, text, 0.0, 1.0);
  } else if (key == "emission") {
    fog.emission = colour(key, text, kMost);
  } else if (key == "blackbody") {
    fog.blackbody = within(key, text, 0.0, kMost);
  } else if (key == "kelvin") {
    fog.kelvin = within(key, text, 1e-6, kHottest);
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
  std::set<std::string> seen;
  for (std::string part; std::getline(parts, part, ',');) {
    const auto equals = part.find('=');
    if (equals == std::string::npos)
      throw UsageError(fmt::format("--fog: found '{}', expected key=value or FILE.json", part));
    const std::string key = part.substr(0, equals);
    if (!seen.insert(key).second) throw UsageError(fmt::format("--fog: found {} twice, expected it once", key));
    setKey(fog, key, part.substr(equals + 1));
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

namespace {

constexpr const char* kRoles[] = {"density", "emission", "temperature"};  // of GridRole

GridRole roleOf(const std::string& role, const std::string& text) {
  for (std::size_t i = 0; i < std::size(kRoles); ++i)
    if (role == kRoles[i]) return static_cast<GridRole>(i);
  throw UsageError(fmt::format("--fog-grid: found {}, expected density, emission or temperature after the =", text));
}

bool has(const std::vector<FogGrid>& grids, GridRole role) {
  return std::any_of(grids.begin(), grids.end(), [&](const FogGrid& grid) { return grid.role == role; });
}

}  // namespace

FogGrid readFogGrid(const std::string& text) {
  FogGrid grid;
  const auto extension = text.rfind(".vdb");
  const auto end = extension == std::string::npos ? text.size() : extension + 4;
  grid.path = text.substr(0, end);
  std::string rest = text.substr(end);
  const auto equals = rest.rfind('=');
  if (equals != std::string::npos) {
    grid.role = roleOf(rest.substr(equals + 1), text);
    rest.resize(equals);
  }
  if (!rest.empty() && (rest[0] != ':' || rest.size() == 1))
    throw UsageError(fmt::format("--fog-grid: found {}, expected FILE.vdb[:GRID][=ROLE]", text));
  if (!rest.empty()) grid.name = rest.substr(1);
  if (equals == std::string::npos && grid.name == "temperature") grid.role = GridRole::temperature;
  if (equals == std::string::npos && (grid.name == "emission" || grid.name == "flames")) grid.role = GridRole::emission;
  return grid;
}

const char* nameOf(GridRole role) {
  return kRoles[static_cast<std::size_t>(role)];
}

void checkFog(const FogText& text, const std::vector<FogGrid>& grids) {
  const bool glows = has(grids, GridRole::emission) || has(grids, GridRole::temperature);
  const bool dense = grids.empty() || has(grids, GridRole::density);
  if (!grids.empty() && (text.medium.box || text.medium.height > 0.0))
    throw UsageError("--fog-grid: found height or box beside it, expected grids that say themselves where they are");
  if (!dense && text.hasDensity)
    throw UsageError("--fog: found density beside grids that only emit, expected a density grid among them");
  if (text.medium.density == 0.0 && !glows && (text.hasDensity || grids.empty()))
    throw UsageError("--fog: found a density of 0, expected density=D, the extinction of a metre");
  if (text.emission && text.medium.density == 0.0 && text.hasDensity && !has(grids, GridRole::emission))
    throw UsageError("--fog: found emission with a density of 0, expected density=D, or an emission grid");
  if (text.emission && !dense && !has(grids, GridRole::emission))
    throw UsageError("--fog: found emission beside temperature alone, expected a grid of density or of emission");
  if (text.medium.collimation < 1.0 && !dense)
    throw UsageError(
        "--fog: found collimation beside grids that only emit, expected a density grid: what hides nothing "
        "spreads nothing");
  if ((text.blackbody || text.kelvin) && !has(grids, GridRole::temperature))
    throw UsageError("--fog: found blackbody or kelvin, expected them with --fog-grid FILE.vdb:GRID=temperature");
}

}  // namespace pellucid
