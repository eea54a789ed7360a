// glTF materials with their extensions, extras.pellucid, and --set.
#pragma once
#include <string>
#include <vector>

#include "engine_bridge/scene/gltf_file.h"
#include "engine_bridge/scene/scene.h"
#include "engine_bridge/scene/textures.h"

namespace pellucid::gltf {

// What the loader makes of an extension's name.
enum class Support {
  full,      // read and drawn
  harmless,  // says nothing about the picture
  none,      // changes geometry or appearance, and is not drawn
};
Support supportFor(const std::string& extension);

//   used  whether its textures show in something that is drawn: only then are its images decoded
// Throws InputError (damaged or missing image, value of a wrong kind), MeaningError (a texture we cannot address).
Material readMaterial(const GltfFile& file, std::size_t index, double metresPerUnit, bool used, TextureReader& textures,
                      Notes& notes);

// glTF's material for primitives that name none.
Material defaultMaterial();

// Applies "MATERIAL.key=value" to every material of that name, in the order given.
// Throws UsageError naming the materials, the keys or the values there are.
void applyOverrides(const std::vector<std::string>& overrides, std::vector<Material>& materials);

// The same for one material, which none of them may name.
void applyOverrides(const std::vector<std::string>& overrides, Material& material);

}  // namespace pellucid::gltf
