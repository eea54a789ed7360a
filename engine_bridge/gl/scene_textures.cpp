#include "engine_bridge/gl/scene_textures.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <stdexcept>

#include "engine_bridge/scene/foliage.h"
#include "gbuffer/errors.h"

namespace pellucid::gl {
namespace {

TexelRange rangeOf(const Image<glm::vec4>& texels) {
  TexelRange range{texels[0], texels[0]};
  for (std::size_t i = 1; i < texels.size(); ++i) {
    range.least = glm::min(range.least, texels[i]);
    range.most = glm::max(range.most, texels[i]);
  }
  return range;
}

GLint wrapOf(Wrap wrap) {
  switch (wrap) {
    case Wrap::repeat:
      return GL_REPEAT;
    case Wrap::mirror:
      return GL_MIRRORED_REPEAT;
    case Wrap::clamp:
      return GL_CLAMP_TO_EDGE;
  }
  throw std::logic_error("a texture wraps in no known way");
}

// Texture units, as shaders/gl/material.glsl numbers them. 5 and 6 are the frame's.
constexpr GLuint kUnits[] = {0, 1, 2, 3, 4, 10, 8, 9};

void uploadLevel(const Texture& texture, GLint level, const Image<glm::vec4>& texels) {
  glTextureSubImage2D(texture.name(), level, 0, 0, texels.width(), texels.height(), GL_RGBA, GL_FLOAT, texels.data());
}

// The cut that the base texture's own alpha has to reach; 0 where there is none to keep coverage for.
float cutOfBase(const Material& material) {
  if (material.alphaMode != AlphaMode::mask || !(material.baseColor.a > 0.0f)) return 0.0f;
  const float cut = material.alphaCutoff / material.baseColor.a;
  return cut <= 1.0f ? cut : 0.0f;
}

}  // namespace

SceneTextures::SceneTextures(const Scene& scene, bool opaque) : scene_(scene) {
  GLint largest = 0;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &largest);
  for (const Material& material : scene.materials) {
    if (material.transparent() == opaque) continue;
    const auto references = material.textures();
    for (std::size_t slot = 0; slot < references.size(); ++slot) {
      const Key key{references[slot]->texture, slot == 0 ? keptCut(material) : 0.0f};
      if (key.first < 0 || uploaded_.count(key)) continue;
      const pellucid::Texture& texture = scene.textures.at(static_cast<std::size_t>(key.first));
      const Image<glm::vec4>& texels = texture.texels;
      if (texels.empty()) throw std::logic_error(texture.name + ": a texture without texels");
      if (std::max(texels.width(), texels.height()) > largest)
        throw ResourceError(fmt::format("{}: texture of {}x{} texels: the GL device holds {} along an edge",
                                        texture.name, texels.width(), texels.height(), largest));
      Uploaded uploaded;
      uploaded.texture = Texture::make();
      const auto edge = static_cast<unsigned>(std::max(texels.width(), texels.height()));
      glTextureStorage2D(uploaded.texture.name(), std::bit_width(edge), GL_RGBA32F, texels.width(), texels.height());
      uploadLevel(uploaded.texture, 0, texels);
      checkGl("uploading texture " + texture.name);
      ranges_.emplace(key.first, rangeOf(texels));
      uploaded_.emplace(key, std::move(uploaded));
    }
  }
}

// A ramp of alpha keeps its cut by averaging; scaled to some area of the whole texture, it would move.
float SceneTextures::keptCut(const Material& material) {
  const int index = material.baseColorTexture.texture;
  const float cut = index < 0 ? 0.0f : cutOfBase(material);
  if (!(cut > 0.0f)) return 0.0f;
  auto known = masks_.find(index);
  if (known == masks_.end())
    known = masks_.emplace(index, measureMask(scene_.textures.at(static_cast<std::size_t>(index)).texels).binary).first;
  return known->second ? cut : 0.0f;
}

TexelRange SceneTextures::range(int index) const {
  return index < 0 ? TexelRange{} : ranges_.at(index);
}

const Sampler& SceneTextures::samplerFor(const pellucid::Texture& texture, TextureFilter filter, float footprint) {
  const bool nearest = texture.nearest || filter == TextureFilter::nearest;
  const bool mipmap = filter == TextureFilter::mipmap;
  const int key =
      ((static_cast<int>(texture.wrapS) * 3 + static_cast<int>(texture.wrapT)) * 2 + (nearest ? 1 : 0)) * 2 +
      (mipmap ? 1 : 0);
  Sampler& sampler = samplers_[{key, mipmap ? footprint : 1.0f}];
  if (!sampler) {
    sampler = Sampler::make();
    const GLint flat = nearest ? GL_NEAREST : GL_LINEAR;
    glSamplerParameteri(sampler.name(), GL_TEXTURE_MAG_FILTER, flat);
    glSamplerParameteri(sampler.name(), GL_TEXTURE_MIN_FILTER, mipmap ? GL_LINEAR_MIPMAP_LINEAR : flat);
    if (mipmap) glSamplerParameterf(sampler.name(), GL_TEXTURE_LOD_BIAS, std::log2(footprint));
    glSamplerParameteri(sampler.name(), GL_TEXTURE_WRAP_S, wrapOf(texture.wrapS));
    glSamplerParameteri(sampler.name(), GL_TEXTURE_WRAP_T, wrapOf(texture.wrapT));
  }
  return sampler;
}

// What a mask covers stays the same at every level; other textures are averaged.
void SceneTextures::makeMipmaps(const Key& key, Uploaded& uploaded) {
  uploaded.mipmaps = true;
  if (key.second <= 0.0f) {
    glGenerateTextureMipmap(uploaded.texture.name());
    return;
  }
  const auto levels = coveragePreservingMips(scene_.textures[static_cast<std::size_t>(key.first)].texels, key.second);
  for (std::size_t level = 1; level < levels.size(); ++level)
    uploadLevel(uploaded.texture, static_cast<GLint>(level), levels[level]);
  checkGl("uploading the mip levels of a mask");
}

void SceneTextures::bind(const Material& material, TextureFilter filter, float footprint) {
  const auto references = material.textures();
  for (std::size_t i = 0; i < references.size(); ++i) {
    const int index = references[i]->texture;
    if (index < 0) continue;
    const Key key{index, i == 0 ? keptCut(material) : 0.0f};
    Uploaded& uploaded = uploaded_.at(key);
    if (filter == TextureFilter::mipmap && !uploaded.mipmaps) makeMipmaps(key, uploaded);
    glBindTextureUnit(kUnits[i], uploaded.texture.name());
    glBindSampler(kUnits[i], samplerFor(scene_.textures[static_cast<std::size_t>(index)], filter, footprint).name());
  }
}

}  // namespace pellucid::gl
