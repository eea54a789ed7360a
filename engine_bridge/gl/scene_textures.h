// A scene's textures on the device, and the samplers that read them.
#pragma once
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "engine_bridge/gl/gl_objects.h"
#include "engine_bridge/gl/transparent_pass.h"

namespace pellucid::gl {

// Bounds of what a texture can return, whatever the filter.
struct TexelRange {
  glm::vec4 least{1.0f}, most{1.0f};
};

class SceneTextures {
 public:
  // Uploads the textures that transparent materials use, or those that opaque ones use. Throws ResourceError for one
  // that the device cannot hold.
  explicit SceneTextures(const Scene& scene, bool opaque = false);
  // Uploads what the materials use now and did not use before: of a scene that has been posed anew.
  void upload();

  // Binds a material's textures to their units, as shaders/gl/material.glsl numbers them.
  //   footprint  of a sample, pixels: mip levels are chosen for it
  void bind(const Material& material, TextureFilter filter, float footprint = 1.0f);
  // What shaders/gl/material.glsl has to know of how a material's textures are stored: defines.
  std::vector<std::string> defines(const Material& material, TextureFilter filter);
  // The coarsest level of a material's base texture that is cut (scene/mask_levels.h), once it was bound with its
  // levels; 0 for those without.
  float maskResolved(const Material& material) const;
  // Of texture `index`; all 1 for -1, as a missing texture counts in a product.
  TexelRange range(int index) const;

 private:
  const Sampler& samplerFor(const pellucid::Texture& texture, TextureFilter filter, float footprint);

  struct Uploaded {
    Texture texture;
    bool mipmaps = false;  // made when a filter first asks for them
    int resolved = 0;      // the coarsest of them that is cut
  };
  struct Key {
    int texture;
    float cut;      // that its levels are made for; 0 for none
    bool weighted;  // colours are times alpha
    auto operator<=>(const Key&) const = default;
  };
  bool weighs(const Material& material);  // its base colour is stored times its alpha
  Key keyOf(const Material& material, std::size_t slot);
  bool readsLevels(const Material& material, TextureFilter filter) const;  // of its base colour
  // That cut for the base colour of a material that it goes through; 0 for others.
  float keptCut(const Material& material) const;
  void makeMipmaps(const Key& key, Uploaded& uploaded);

  const Scene& scene_;
  bool opaque_;
  std::map<Key, Uploaded> uploaded_;
  std::map<std::pair<int, bool>, bool> weighs_;  // by texture, and whether every alpha passes
  std::map<int, TexelRange> ranges_;
  std::map<std::pair<Sampling, float>, Sampler> samplers_;  // and by footprint
};

}  // namespace pellucid::gl
