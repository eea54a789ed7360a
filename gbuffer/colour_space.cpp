#include "gbuffer/colour_space.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iterator>
#include <sstream>

#include "gbuffer/errors.h"
#include "gbuffer/lower_case.h"

namespace pellucid {
namespace {

// Chromaticities are told to four digits, and some programs round them otherwise.
constexpr double kSamePrimaries = 2e-4;

// In the order of SpaceSource.
constexpr const char* kSources[] = {
    "nothing",        "the preset",     "the config's default rule", "the config's file rules",
    "chromaticities", "--working-space"};

constexpr const char *kName = "pellucid:workingSpace", *kSource = "pellucid:workingSpaceBy",
                     *kMatrix = "pellucid:workingSpaceFromRec709";

const glm::dvec2 kWhiteD65{0.3127, 0.3290}, kWhiteAces{0.32168, 0.33767};

glm::dvec3 xyzOf(const glm::dvec2& xy) {
  return {xy.x / xy.y, 1.0, (1.0 - xy.x - xy.y) / xy.y};
}

// Of linear light, white at Y = 1.
glm::dmat3 xyzFromRgb(const Chromaticities& space) {
  const auto column = [](const glm::dvec2& xy) { return glm::dvec3(xy, 1.0 - xy.x - xy.y); };
  const glm::dmat3 primaries(column(space.red), column(space.green), column(space.blue));
  const glm::dvec3 scale = glm::inverse(primaries) * xyzOf(space.white);
  return {primaries[0] * scale.x, primaries[1] * scale.y, primaries[2] * scale.z};
}

// Lam, 1985: cones that are sharper than those of the eye, each scaled by what the whites send them.
glm::dmat3 bradford(const glm::dvec2& from, const glm::dvec2& to) {
  const glm::dmat3 cones =
      glm::transpose(glm::dmat3(0.8951, 0.2664, -0.1614, -0.7502, 1.7135, 0.0367, 0.0389, -0.0685, 1.0296));
  const glm::dvec3 scale = (cones * xyzOf(to)) / (cones * xyzOf(from));
  return glm::inverse(cones) * glm::dmat3(scale.x, 0, 0, 0, scale.y, 0, 0, 0, scale.z) * cones;
}

bool finite(const glm::dmat3& matrix) {
  for (int c = 0; c < 3; ++c)
    for (int r = 0; r < 3; ++r)
      if (!(std::abs(matrix[c][r]) < 1e6)) return false;
  return true;
}

bool near(const glm::dvec2& a, const glm::dvec2& b) {
  return std::abs(a.x - b.x) <= kSamePrimaries && std::abs(a.y - b.y) <= kSamePrimaries;
}

bool near(const Chromaticities& a, const Chromaticities& b) {
  return near(a.red, b.red) && near(a.green, b.green) && near(a.blue, b.blue) && near(a.white, b.white);
}

std::string primariesText(const Chromaticities& space) {
  return fmt::format("({:.4g}, {:.4g}) ({:.4g}, {:.4g}) ({:.4g}, {:.4g}), white ({:.4g}, {:.4g})", space.red.x,
                     space.red.y, space.green.x, space.green.y, space.blue.x, space.blue.y, space.white.x,
                     space.white.y);
}

ColourSpace spaceOf(const NamedSpace& row) {
  ColourSpace space;
  space.name = row.name;
  space.chromaticities = row.chromaticities;
  space.fromRec709 = &row == &namedSpaces()[0] ? glm::dmat3(1.0) : *fromRec709(row.chromaticities);
  return space;
}

}  // namespace

const std::vector<NamedSpace>& namedSpaces() {
  // The first is glTF's own.
  static const std::vector<NamedSpace> table{
      {"Linear Rec.709 (sRGB)",
       {"Linear Rec.709", "lin_rec709_scene", "lin_rec709", "lin_srgb", "Linear sRGB", "Utility - Linear - sRGB",
        "Utility - Linear - Rec.709"},
       {}},
      {"ACEScg",
       {"lin_ap1_scene", "lin_ap1", "ACES - ACEScg"},
       {{0.713, 0.293}, {0.165, 0.830}, {0.128, 0.044}, kWhiteAces}},
      {"ACES2065-1",
       {"lin_ap0_scene", "lin_ap0", "aces2065_1", "ACES - ACES2065-1"},
       {{0.7347, 0.2653}, {0.0, 1.0}, {0.0001, -0.0770}, kWhiteAces}},
      {"Linear Rec.2020",
       {"lin_rec2020_scene", "lin_rec2020", "Utility - Linear - Rec.2020"},
       {{0.708, 0.292}, {0.170, 0.797}, {0.131, 0.046}, kWhiteD65}},
      {"Linear P3-D65",
       {"lin_p3d65_scene", "lin_p3d65", "lin_displayp3", "Utility - Linear - P3-D65"},
       {{0.680, 0.320}, {0.265, 0.690}, {0.150, 0.060}, kWhiteD65}},
  };
  return table;
}

const NamedSpace* namedSpace(const std::string& name) {
  const std::string wanted = lowerCase(name);
  for (const NamedSpace& row : namedSpaces()) {
    if (lowerCase(row.name) == wanted) return &row;
    for (const char* alias : row.aliases)
      if (lowerCase(alias) == wanted) return &row;
  }
  return nullptr;
}

std::string spaceNames() {
  std::string names;
  for (const NamedSpace& row : namedSpaces()) names += (names.empty() ? "" : ", ") + std::string(row.name);
  return names;
}

std::string spacesHelp() {
  std::string text = "auto: by the EXR's chromaticities, then the config's file rules, then the preset\n";
  for (const NamedSpace& row : namedSpaces()) {
    std::string aliases;
    for (const char* alias : row.aliases) aliases += (aliases.empty() ? "also " : ", ") + std::string(alias);
    text += fmt::format("{}: primaries {}; {}\n", row.name, primariesText(row.chromaticities), aliases);
  }
  return text;
}

std::optional<glm::dmat3> fromRec709(const Chromaticities& space) {
  for (const glm::dvec2& each : {space.red, space.green, space.blue, space.white})
    if (!std::isfinite(each.x) || !std::isfinite(each.y)) return std::nullopt;
  if (!(space.white.y > 1e-6)) return std::nullopt;
  const glm::dmat3 there = xyzFromRgb(space), back = glm::inverse(there);
  const glm::dmat3 matrix = back * bradford(kWhiteD65, space.white) * xyzFromRgb({});
  if (!finite(there) || !finite(back) || !finite(matrix)) return std::nullopt;
  return matrix;
}

std::optional<ColourSpace> spaceOf(const Chromaticities& primaries) {
  for (const NamedSpace& row : namedSpaces())
    if (near(primaries, row.chromaticities)) return spaceOf(row);
  const std::optional<glm::dmat3> matrix = fromRec709(primaries);
  if (!matrix) return std::nullopt;
  ColourSpace space;
  space.name = "linear, of primaries " + primariesText(primaries);
  space.fromRec709 = *matrix;
  space.chromaticities = primaries;
  return space;
}

ColourSpace spaceBy(const std::string& name, const glm::dmat3& fromRec709) {
  ColourSpace space;
  space.name = name;
  space.fromRec709 = fromRec709;
  const glm::dmat3 xyz = xyzFromRgb({}) * glm::inverse(fromRec709);
  const auto xyOf = [](const glm::dvec3& light) { return glm::dvec2(light) / (light.x + light.y + light.z); };
  space.chromaticities = {xyOf(xyz[0]), xyOf(xyz[1]), xyOf(xyz[2]), xyOf(xyz[0] + xyz[1] + xyz[2])};
  return space;
}

std::vector<float> numbersOf(const Chromaticities& space) {
  std::vector<float> numbers;
  for (const glm::dvec2& each : {space.red, space.green, space.blue, space.white})
    numbers.insert(numbers.end(), {static_cast<float>(each.x), static_cast<float>(each.y)});
  return numbers;
}

std::vector<float> chromaticitiesToWrite(const ColourSpace& space) {
  if (space.isRec709() && space.source != SpaceSource::chromaticities) return {};
  return numbersOf(space.chromaticities);
}

std::optional<Chromaticities> chromaticitiesOf(const ExrPart& part) {
  const auto found = part.attributes.find("chromaticities");
  if (found == part.attributes.end() || found->second.type != "chromaticities" || found->second.bytes.size() != 32)
    return std::nullopt;
  float numbers[8];
  std::memcpy(numbers, found->second.bytes.data(), sizeof numbers);
  const auto pair = [&](int i) { return glm::dvec2(glm::vec2(numbers[2 * i], numbers[2 * i + 1])); };
  return Chromaticities{pair(0), pair(1), pair(2), pair(3)};
}

ColourSpace statedSpace(const ExrPart& part, const std::string& preset, std::vector<std::string>& notes) {
  if (const std::optional<Chromaticities> stated = chromaticitiesOf(part)) {
    if (std::optional<ColourSpace> space = spaceOf(*stated)) {
      space->source = SpaceSource::chromaticities;
      return *space;
    }
    notes.push_back(fmt::format("attribute chromaticities: found {}, which span no colours, so they are not taken",
                                primariesText(*stated)));
  } else if (const auto found = part.attributes.find("chromaticities"); found != part.attributes.end()) {
    notes.push_back(
        fmt::format("attribute chromaticities: found {} of {} bytes, expected 8 numbers of the type "
                    "chromaticities, so they are not taken",
                    found->second.type, found->second.bytes.size()));
  }
  const NamedSpace* row = namedSpace(preset);
  ColourSpace space = spaceOf(row ? *row : namedSpaces()[0]);
  space.source = row ? SpaceSource::preset : SpaceSource::nothing;
  return space;
}

const char* nameOf(SpaceSource source) {
  return kSources[static_cast<int>(source)];
}

std::string spaceText(const ColourSpace& space) {
  if (space.source == SpaceSource::nothing) return space.name + ", as nothing says otherwise";
  return space.name + " by " + nameOf(space.source);
}

bool sameSpace(const ColourSpace& a, const ColourSpace& b) {
  constexpr double kSlack = 1e-6;  // chromaticities are floats
  for (int c = 0; c < 3; ++c)
    for (int r = 0; r < 3; ++r)
      if (!(std::abs(a.fromRec709[c][r] - b.fromRec709[c][r]) <= kSlack)) return false;
  return true;
}

void putSpace(const ColourSpace& space, std::map<std::string, std::string>& attributes) {
  std::string rows;
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) rows += fmt::format("{}{:.17g}", rows.empty() ? "" : " ", space.fromRec709[c][r]);
  attributes[kName] = space.name;
  attributes[kSource] = nameOf(space.source);
  attributes[kMatrix] = rows;
}

ColourSpace readSpace(const ExrPart& part, const std::string& path) {
  const std::optional<std::string> name = part.text(kName), source = part.text(kSource), rows = part.text(kMatrix);
  if (!name) return {};
  const auto by = std::find(std::begin(kSources), std::end(kSources), source.value_or(""));
  glm::dmat3 matrix(0.0);
  std::istringstream in(rows.value_or(""));
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) in >> matrix[c][r];
  if (by == std::end(kSources) || !in || !finite(matrix) || !(std::abs(glm::determinant(matrix)) > 1e-9))
    throw MeaningError(fmt::format("{}: attribute {}: found '{}' by '{}' of '{}', expected what accumulate writes",
                                   path, kName, *name, source.value_or(""), rows.value_or("")));
  ColourSpace space = spaceBy(*name, matrix);
  space.source = static_cast<SpaceSource>(by - std::begin(kSources));
  return space;
}

glm::vec3 converted(const glm::dmat3& matrix, const glm::vec3& colour) {
  // White goes to white: only what differs from the least channel needs the matrix.
  const double grey = static_cast<double>(std::min({colour.r, colour.g, colour.b}));
  const glm::dvec3 rest = glm::dvec3(colour) - grey;
  return glm::vec3(glm::max(grey + matrix * rest, glm::dvec3(0.0)));
}

}  // namespace pellucid
