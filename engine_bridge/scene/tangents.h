// Tangents for normal textures, where a file has none.
#pragma once
#include "engine_bridge/scene/scene.h"

namespace pellucid::gltf {

// As MikkTSpace does: each corner's direction of rising u, in the plane of its normal, averaged by angle over the
// corners that share position, normal, texture coordinates and handedness; vertices that two handednesses meet at are
// doubled. Unlike it, corners count as shared wherever they coincide, whether or not an edge joins them.
//   normals  the texture's coordinates, transform included
void makeTangents(Primitive& primitive, const TextureRef& normals);

}  // namespace pellucid::gltf
