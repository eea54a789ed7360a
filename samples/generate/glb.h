// A binary glTF file, put together piece by piece.
#pragma once
#include <glm/glm.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "samples/generate/mesh.h"
#include "samples/generate/view.h"

namespace pellucid::samples {

// Particles: middles, radii in metres, colours (linear, with alpha) or none.
struct Points {
  std::vector<glm::vec3> positions;
  std::vector<float> radii;
  std::vector<glm::vec4> colours;
};

class Glb {
 public:
  Glb();
  int addTexture(const std::string& name, const std::vector<unsigned char>& png);  // clamped; returns its index
  int addMaterial(nlohmann::json material);  // a glTF material; its extensions are noted as used
  void addMesh(const std::string& node, const Mesh& mesh, int material, glm::dvec3 position = glm::dvec3(0.0));
  void addPoints(const std::string& node, const Points& points, int material);
  void addCamera(const std::string& node, const View& view);
  // A directional light. Irradiance in W/m^2 on a plane facing it; the file holds lux, at 683 lm/W.
  void addSun(const std::string& node, glm::dvec3 toSun, glm::dvec3 irradiance);

  std::vector<unsigned char> bytes() const;

 private:
  int addView(const void* data, std::size_t size, int target);
  int addAccessor(int view, int componentType, std::size_t count, const char* type);
  void addNode(nlohmann::json node);

  nlohmann::json json_;
  std::vector<unsigned char> binary_;
};

// A glass-like material without metal: `colour` tints each surface that light crosses.
nlohmann::json glass(const std::string& name, glm::dvec3 colour, double ior, double roughness);
std::vector<double> list(glm::dvec3 v);

}  // namespace pellucid::samples
