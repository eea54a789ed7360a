#include "engine_bridge/scene/instancing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <initializer_list>

#include "engine_bridge/scene/accessor.h"

namespace pellucid::gltf {

namespace {

std::optional<Elements> read(GltfFile& file, const JsonView& attributes, const char* name,
                             std::initializer_list<std::size_t> widths, Integers integers) {
  const std::optional<JsonView> reference = attributes.find(name);
  if (!reference) return std::nullopt;
  Elements elements = readElements(file, *reference, widths, integers);
  for (const float value : elements.values)
    if (!std::isfinite(value)) reference->refuse("holds a value that is not finite");
  return elements;
}

}  // namespace

std::optional<std::vector<InstancePlace>> instancesOf(GltfFile& file, const JsonView& node) {
  const std::optional<JsonView> extension = node.extension("EXT_mesh_gpu_instancing");
  if (!extension) return std::nullopt;
  const JsonView attributes = extension->at("attributes");
  const std::optional<Elements> moves = read(file, attributes, "TRANSLATION", {3}, Integers::none);
  const std::optional<Elements> turns = read(file, attributes, "ROTATION", {4}, Integers::normalised);
  const std::optional<Elements> scales = read(file, attributes, "SCALE", {3}, Integers::none);
  const std::optional<Elements> colours = read(file, attributes, "_COLOR_0", {3, 4}, Integers::normalised);
  std::size_t count = 0;
  for (const std::optional<Elements>* elements : {&moves, &turns, &scales, &colours}) {
    if (!*elements) continue;
    if (count != 0 && (*elements)->count != count)
      attributes.refuse(fmt::format("have {} and {} elements; expected equal counts", count, (*elements)->count));
    count = (*elements)->count;
  }
  if (count == 0) attributes.refuse("have none of TRANSLATION, ROTATION, SCALE and _COLOR_0");
  std::vector<InstancePlace> places(count);
  const auto at = [](const Elements& elements, std::size_t i, std::size_t c) {
    return static_cast<double>(elements.at(i, c));
  };
  for (std::size_t i = 0; i < count; ++i) {
    glm::dmat4& transform = places[i].transform;
    if (turns) {
      const glm::dquat turn(at(*turns, i, 3), at(*turns, i, 0), at(*turns, i, 1), at(*turns, i, 2));  // glTF: x y z w
      const double length = glm::length(turn);
      if (length < 1e-30) attributes.at("ROTATION").refuse(fmt::format("has no length at instance {}", i));
      transform = glm::mat4_cast(turn / length);
    }
    for (std::size_t c = 0; scales && c < 3; ++c) transform[static_cast<int>(c)] *= at(*scales, i, c);
    if (moves) transform[3] = glm::dvec4(at(*moves, i, 0), at(*moves, i, 1), at(*moves, i, 2), 1.0);
    for (std::size_t c = 0; colours && c < colours->width; ++c)
      places[i].colour[static_cast<int>(c)] = std::clamp(colours->at(i, c), 0.0f, 1.0f);
  }
  return places;
}

}  // namespace pellucid::gltf
