#include "engine_bridge/scene/pose.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>

#include "engine_bridge/scene/placed.h"

namespace pellucid::gltf {

namespace {

constexpr double kMostWeight = 1e6;

std::vector<double> weightsOf(const JsonView& node, const JsonView& mesh) {
  const std::optional<JsonView> own = node.find("weights");
  const std::optional<JsonView> source = own ? own : mesh.find("weights");
  std::vector<double> weights = source ? source->numbers(source->size()) : std::vector<double>{};
  for (const double weight : weights)
    if (!(std::abs(weight) <= kMostWeight))
      source->refuse(fmt::format("holds {:g}; expected magnitudes up to {:g}", weight, kMostWeight));
  if (std::all_of(weights.begin(), weights.end(), [](double weight) { return weight == 0.0; })) weights.clear();
  return weights;
}

glm::dvec3 vec3At(const Elements& elements, std::size_t i) {
  return {elements.at(i, 0), elements.at(i, 1), elements.at(i, 2)};
}

void store(Elements& elements, std::size_t i, glm::dvec3 value) {
  for (int c = 0; c < 3; ++c)
    elements.values[i * elements.width + static_cast<std::size_t>(c)] = static_cast<float>(value[c]);
}

void morph(GltfFile& file, const JsonView& primitive, const std::vector<double>& weights, bool quantised,
           const PosedAttributes& posed, PoseRepairs& repairs) {
  const std::optional<JsonView> targets = primitive.find("targets");
  const std::size_t count = targets ? targets->size() : 0;
  if (count != weights.size()) ++repairs.otherWeights;
  const auto add = [&](const JsonView& target, const char* name, std::initializer_list<std::size_t> widths,
                       double weight, Integers integers, Elements* base) {
    const std::optional<JsonView> reference = target.find(name);
    if (!reference || !base) return;
    const Elements moved = readElements(file, *reference, widths, integers);
    const std::size_t width = std::min(moved.width, base->width);
    if (moved.count != base->count)
      reference->refuse(fmt::format("has {} elements; expected {}, as POSITION has", moved.count, base->count));
    for (std::size_t i = 0; i < base->count; ++i)
      for (std::size_t c = 0; c < width; ++c) {
        float& value = base->values[i * base->width + c];
        value = static_cast<float>(static_cast<double>(value) + weight * static_cast<double>(moved.at(i, c)));
      }
  };
  for (std::size_t k = 0; k < std::min(count, weights.size()); ++k) {
    if (weights[k] == 0.0) continue;
    const JsonView target = targets->at(k);
    const Integers units = quantised ? Integers::normalised : Integers::none;
    const Integers free = quantised ? Integers::any : Integers::none;
    add(target, "POSITION", {3}, weights[k], free, posed.positions);
    add(target, "NORMAL", {3}, weights[k], units, posed.normals);
    add(target, "TANGENT", {3}, weights[k], units, posed.tangents);
    add(target, "COLOR_0", {3, 4}, weights[k], Integers::asNormalised, posed.colours);
    const Integers mapped = quantised ? Integers::any : Integers::normalised;
    add(target, "TEXCOORD_0", {2}, weights[k], mapped, posed.uvs[0]);
    add(target, "TEXCOORD_1", {2}, weights[k], mapped, posed.uvs[1]);
  }
}

// The mean of a vertex's joints, by their weights.
struct Blend {
  glm::dmat4 sum{0.0};
  double weight = 0;
  std::size_t first = 0;
};

glm::dmat3 cofactors(const glm::dmat3& m) {
  return {glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1])};
}

void bend(GltfFile& file, const JsonView& primitive, const std::vector<glm::dmat4>& joints, PosedAttributes& posed,
          PoseRepairs& repairs) {
  Elements& positions = *posed.positions;
  posed.mirrored.assign(positions.count, false);
  const JsonView attributes = primitive.at("attributes");
  std::vector<Blend> blends(positions.count);
  attributes.at("JOINTS_0");
  for (int set = 0;; ++set) {
    const std::string jointName = fmt::format("JOINTS_{}", set), weightName = fmt::format("WEIGHTS_{}", set);
    const std::optional<JsonView> reference = attributes.find(jointName.c_str());
    if (!reference) break;
    const Elements indices = readElements(file, *reference, {4}, Integers::any);
    const Elements weights = readElements(file, attributes.at(weightName.c_str()), {4}, Integers::normalised);
    if (indices.count != positions.count || weights.count != positions.count)
      reference->refuse(fmt::format("has {} elements and {} weights; expected {}, as POSITION has", indices.count,
                                    weights.count, positions.count));
    for (std::size_t i = 0; i < positions.count; ++i) {
      for (std::size_t c = 0; c < 4; ++c) {
        const auto index = static_cast<double>(indices.at(i, c)), weight = static_cast<double>(weights.at(i, c));
        if (!(index >= 0.0 && index < static_cast<double>(joints.size())))
          reference->refuse(fmt::format("name joint {:g}; expected indices below {}", index, joints.size()));
        if (set == 0 && c == 0) blends[i].first = static_cast<std::size_t>(index);
        if (!(weight > 0.0) || !std::isfinite(weight)) continue;
        blends[i].sum += weight * joints[static_cast<std::size_t>(index)];
        blends[i].weight += weight;
      }
    }
  }
  for (std::size_t i = 0; i < positions.count; ++i) {
    const Blend& blend = blends[i];
    const bool bound = blend.weight > 0.0;
    repairs.unbound += bound ? 0 : 1;
    const glm::dmat4 moved = bound ? blend.sum / blend.weight : joints[blend.first];
    store(positions, i, glm::dvec3(moved * glm::dvec4(vec3At(positions, i), 1.0)));
    const glm::dmat3 linear(moved);
    const bool mirrored = mirrors(moved);
    posed.mirrored[i] = mirrored;
    const auto turn = [&](Elements* elements, const glm::dmat3& by) {
      if (!elements) return;
      const glm::dvec3 turned = by * vec3At(*elements, i);
      const double length = glm::length(turned);
      store(*elements, i, length > 0.0 ? turned / length : glm::dvec3(0.0));
    };
    turn(posed.normals, (mirrored ? -1.0 : 1.0) * cofactors(linear));
    turn(posed.tangents, linear);
    // Mirrored, a right-handed frame is a left-handed one.
    if (posed.tangents && mirrored) posed.tangents->values[i * posed.tangents->width + 3] *= -1.0f;
  }
}

bool hasJoints(const JsonView& mesh) {
  const JsonView primitives = mesh.at("primitives");
  for (std::size_t i = 0; i < primitives.size(); ++i)
    if (primitives.at(i).at("attributes").find("JOINTS_0")) return true;
  return false;
}

}  // namespace

PoseReader::PoseReader(GltfFile& file, const std::vector<PlacedNode>& placed, double metresPerUnit, Notes& notes)
    : file_(&file), metresPerUnit_(metresPerUnit), notes_(&notes) {
  for (const PlacedNode& node : placed) worldOf_.emplace(node.index, &node.worldFromObject);
}

const std::vector<glm::dmat4>& PoseReader::jointsOf(const JsonView& node) {
  const JsonView reference = node.at("skin");
  const std::size_t index = reference.index(file_->count("skins"), "skins");
  if (const auto found = skins_.find(index); found != skins_.end()) return found->second;
  const JsonView skin = file_->item("skins", index);
  const JsonView joints = skin.at("joints");
  std::optional<Elements> inverse;
  if (const std::optional<JsonView> matrices = skin.find("inverseBindMatrices")) {
    inverse = readElements(*file_, *matrices, {16}, Integers::none);
    if (inverse->count < joints.size())
      matrices->refuse(fmt::format("are {}; the skin has {} joints", inverse->count, joints.size()));
    for (const float value : inverse->values)
      if (!std::isfinite(value)) matrices->refuse("hold a value that is not finite");
  }
  if (joints.size() == 0) joints.refuse("are none; expected at least one");
  std::vector<glm::dmat4> result;
  for (std::size_t k = 0; k < joints.size(); ++k) {
    const std::size_t at = joints.at(k).index(file_->count("nodes"), "nodes");
    const auto world = worldOf_.find(at);
    const bool stray = world == worldOf_.end();
    if (stray)
      notes_->add(fmt::format("{} is {}, a node that the scene does not hold; it stands where its parents place it",
                              joints.at(k).where(), at));
    glm::dmat4 unitsFromMetres(1.0 / metresPerUnit_);
    unitsFromMetres[3][3] = 1.0;
    glm::dmat4 bind(1.0);
    for (int column = 0; inverse && column < 4; ++column)
      for (int row = 0; row < 3; ++row)
        bind[column][row] = static_cast<double>(inverse->at(k, static_cast<std::size_t>(column * 4 + row)));
    result.push_back(unitsFromMetres *
                     (stray ? worldBesideScene(*file_, at, metresPerUnit_, *notes_) : *world->second) * bind);
  }
  return skins_.emplace(index, std::move(result)).first->second;
}

Pose PoseReader::of(const JsonView& node, const JsonView& mesh) {
  Pose pose;
  pose.weights = weightsOf(node, mesh);
  if (node.find("skin") && hasJoints(mesh))
    pose.joints = jointsOf(node);
  else if (node.find("skin"))
    notes_->add(node.where() + " has a skin, and no primitive of its mesh has JOINTS_0: it stands where the node does");
  return pose;
}

void applyPose(GltfFile& file, const JsonView& primitive, const Pose& pose, bool quantised, PosedAttributes& posed,
               PoseRepairs& repairs) {
  if (!pose.weights.empty()) morph(file, primitive, pose.weights, quantised, posed, repairs);
  if (!pose.joints.empty()) bend(file, primitive, pose.joints, posed, repairs);
}

}  // namespace pellucid::gltf
