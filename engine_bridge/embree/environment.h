// The light that comes from everywhere: a constant, or a lat-long picture of the surroundings.
#pragma once
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "gbuffer/image.h"

namespace pellucid {

class Environment {
 public:
  Environment() = default;                   // black
  explicit Environment(glm::vec3 radiance);  // the same from everywhere, scene-linear, >= 0
  // Rows from +y down to -y, laid out as shaders/shared/environment.glsl says. Values >= 0, finite.
  explicit Environment(Image<glm::vec3> latLong);

  bool black() const { return map_.empty() && constant_ == glm::vec3(0.0f); }
  bool constant() const { return map_.empty(); }
  const Image<glm::vec3>& map() const { return map_; }  // empty for a constant

  // Radiance from a direction (world, unit), bilinear between texels.
  glm::vec3 radiance(glm::vec3 towards) const;

  // A direction with density by what the texels send. Only for maps.
  struct Chosen {
    glm::vec3 towards;  // world, unit
    float density;      // per steradian, 0 when there is nothing to choose
  };
  Chosen choose(glm::vec2 random) const;
  float density(glm::vec3 towards) const;  // of choose()

 private:
  glm::vec3 constant_{0.0f};
  Image<glm::vec3> map_;
  std::vector<double> rows_;     // cumulative, height + 1, the last is 1
  std::vector<double> columns_;  // per row cumulative, width + 1 each
  double total_ = 0;
};

// Beauty of an EXR twice as wide as high, or as wide as it likes. What is negative or not finite counts as black, which
// is noted. Its colours are those of its own space, linear Rec.709 where it states none, and are brought into another.
// Throws InputError (missing, damaged), MeaningError (no beauty, or two).
//   fromRec709  of the space to bring it into
Environment readEnvironment(const std::string& path, std::vector<std::string>& notes,
                            const glm::dmat3& fromRec709 = glm::dmat3(1.0));

}  // namespace pellucid
