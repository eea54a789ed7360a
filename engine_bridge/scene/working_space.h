// A scene's colours, which glTF has in linear Rec.709, brought into the space of the picture: once, after loading,
// and again for what a pose has read anew.
#pragma once
#include "engine_bridge/scene/scene.h"

namespace pellucid {

// Reflected and emitted colours are light under white: base colours, specular tints, vertex colours, emission, lamps
// and the textures of all these go through the matrix. So does what a filter lets through, attenuation and the base
// colour of what transmits: white light through it is then right whatever the space, a neutral filter stays neutral,
// and none lets through more than all. What would leave [0, 1] or become negative, as colours outside of a narrow space
// do, is brought to its edge, which the notes say.
//   matrix  linear Rec.709 to the picture's space, white to white; the identity changes no bit, but for textures that
//           state a space of their own
//   primitives  those that are not in it yet, of a scene that has been posed anew; null: all
std::vector<std::string> bringInto(Scene& scene, const glm::dmat3& matrix,
                                   const std::vector<int>* primitives = nullptr);

}  // namespace pellucid
