#include "engine_bridge/gl/scene_textures.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <stdexcept>

#include "engine_bridge/scene/foliage.h"
#include "engine_bridge/scene/mask_levels.h"
#include "gbuffer/errors.h"

namespace pellucid::gl {
namespace {

TexelRange rangeOf(const pellucid::Texture& texture) {
  const Image<glm::vec4>& texels = texture.texels;
  if (texels.empty()) throw std::logic_error(texture.name + ": a texture without texels");
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

GLint minFilterOf(Minify minify) {
  switch (minify) {
    case Minify::nearest:
      return GL_NEAREST;
    case Minify::linear:
      return GL_LINEAR;
    case Minify::nearestMipNearest:
      return GL_NEAREST_MIPMAP_NEAREST;
    case Minify::linearMipNearest:
      return GL_LINEAR_MIPMAP_NEAREST;
    case Minify::nearestMipLinear:
      return GL_NEAREST_MIPMAP_LINEAR;
    case Minify::linearMipLinear:
      return GL_LINEAR_MIPMAP_LINEAR;
  }
  throw std::logic_error("a texture is minified in no known way");
}

bool hasLevels(Minify minify) {
  return minify != Minify::nearest && minify != Minify::linear;
}

// Texture units, as shaders/gl/material.glsl numbers them. 5 and 6 are the frame's.
constexpr GLuint kUnits[] = {0, 1, 2, 3, 4, 10, 8, 9};

void uploadLevel(const Texture& texture, GLint level, const Image<glm::vec4>& texels) {
  glTextureSubImage2D(texture.name(), level, 0, 0, texels.width(), texels.height(), GL_RGBA, GL_FLOAT, texels.data());
}

// Colours times alpha: what is filtered is then weighted by it.
Image<glm::vec4> weighted(Image<glm::vec4> texels) {
  for (std::size_t i = 0; i < texels.size(); ++i) {
    const float alpha = texels[i].a;
    texels[i] = glm::vec4(glm::vec3(texels[i]) * alpha, alpha);
  }
  return texels;
}

}  // namespace

SceneTextures::SceneTextures(const Scene& scene, bool opaque) : scene_(scene), opaque_(opaque) {
  upload();
}

void SceneTextures::upload() {
  GLint largest = 0;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &largest);
  for (const Material& material : scene_.materials) {
    if (material.transparent() == opaque_) continue;
    const auto references = material.textures();
    for (const TextureRef* reference : references)
      if (const int index = reference->texture; index >= 0 && !ranges_.count(index))
        ranges_.emplace(index, rangeOf(scene_.textures.at(static_cast<std::size_t>(index))));
    for (std::size_t slot = 0; slot < references.size(); ++slot) {
      const Key key = keyOf(material, slot);
      if (key.texture < 0 || uploaded_.count(key)) continue;
      const pellucid::Texture& texture = scene_.textures.at(static_cast<std::size_t>(key.texture));
      const Image<glm::vec4>& texels = texture.texels;
      if (std::max(texels.width(), texels.height()) > largest)
        throw ResourceError(fmt::format("{}: texture of {}x{} texels: the GL device holds {} along an edge",
                                        texture.name, texels.width(), texels.height(), largest));
      Uploaded uploaded;
      uploaded.texture = Texture::make();
      const auto edge = static_cast<unsigned>(std::max(texels.width(), texels.height()));
      glTextureStorage2D(uploaded.texture.name(), std::bit_width(edge), GL_RGBA32F, texels.width(), texels.height());
      uploadLevel(uploaded.texture, 0, key.weighted ? weighted(texels) : texels);
      checkGl("uploading texture " + texture.name);
      uploaded_.emplace(key, std::move(uploaded));
    }
  }
}

float SceneTextures::keptCut(const Material& material) const {
  const int index = material.baseColorTexture.texture;
  const float cut = index < 0 ? 0.0f : cutOfBase(material);
  if (!(cut > 0.0f)) return 0.0f;
  const TexelRange range = ranges_.at(index);
  return range.least.a < cut && range.most.a >= cut ? cut : 0.0f;
}

bool SceneTextures::weighs(const Material& material) {
  const int index = material.baseColorTexture.texture;
  if (index < 0 || material.alphaMode == AlphaMode::opaque) return false;
  const auto known = std::make_pair(index, material.alphaMode == AlphaMode::mask && material.alphaCutoff <= 0.0f);
  const auto found = weighs_.find(known);
  return found != weighs_.end() ? found->second : weighs_.emplace(known, weighsByAlpha(material, scene_)).first->second;
}

SceneTextures::Key SceneTextures::keyOf(const Material& material, std::size_t slot) {
  const int texture = material.textures()[slot]->texture;
  return slot == 0 ? Key{texture, keptCut(material), weighs(material)} : Key{texture, 0.0f, false};
}

std::vector<std::string> SceneTextures::defines(const Material& material, TextureFilter filter) {
  std::vector<std::string> defines;
  if (weighs(material)) defines.emplace_back("BASE_WEIGHTED");
  if (material.alphaMode != AlphaMode::mask || material.baseColorTexture.texture < 0) return defines;
  if (!readsLevels(material, filter))
    defines.emplace_back("MASK_UNLEVELLED");
  else if (keptCut(material) > 0.0f)
    defines.emplace_back("MASK_LEVELLED");
  return defines;
}

bool SceneTextures::readsLevels(const Material& material, TextureFilter filter) const {
  const auto base = static_cast<std::size_t>(material.baseColorTexture.texture);
  return filter == TextureFilter::mipmap && hasLevels(scene_.textures[base].minify);
}

float SceneTextures::maskResolved(const Material& material) const {
  const float cut = keptCut(material);
  if (!(cut > 0.0f)) return 0.0f;
  const auto found = uploaded_.lower_bound({material.baseColorTexture.texture, cut, false});
  return found == uploaded_.end() ? 0.0f : static_cast<float>(found->second.resolved);
}

TexelRange SceneTextures::range(int index) const {
  return index < 0 ? TexelRange{} : ranges_.at(index);
}

const Sampler& SceneTextures::samplerFor(const pellucid::Texture& texture, TextureFilter filter, float footprint) {
  const bool nearest = texture.nearest || filter == TextureFilter::nearest;
  const bool flag = filter != TextureFilter::mipmap;  // reads level 0, whatever the file says
  const bool mipmap = !flag && hasLevels(texture.minify);
  Sampling sampling = texture;
  sampling.nearest = nearest;
  if (flag) sampling.minify = nearest ? Minify::nearest : Minify::linear;
  Sampler& sampler = samplers_[{sampling, mipmap ? footprint : 1.0f}];
  if (!sampler) {
    sampler = Sampler::make();
    const GLint flat = nearest ? GL_NEAREST : GL_LINEAR;
    glSamplerParameteri(sampler.name(), GL_TEXTURE_MAG_FILTER, flat);
    glSamplerParameteri(sampler.name(), GL_TEXTURE_MIN_FILTER, minFilterOf(sampling.minify));
    if (mipmap) glSamplerParameterf(sampler.name(), GL_TEXTURE_LOD_BIAS, std::log2(footprint));
    glSamplerParameteri(sampler.name(), GL_TEXTURE_WRAP_S, wrapOf(texture.wrapS));
    glSamplerParameteri(sampler.name(), GL_TEXTURE_WRAP_T, wrapOf(texture.wrapT));
  }
  return sampler;
}

// Of a mask, those that hold its pattern cover what it covers; of other textures that are cut, they are plain means.
// Coarser ones hold what the cut leaves.
void SceneTextures::makeMipmaps(const Key& key, Uploaded& uploaded) {
  uploaded.mipmaps = true;
  const pellucid::Texture& texture = scene_.textures[static_cast<std::size_t>(key.texture)];
  const bool binary = key.cut > 0.0f && measureMask(texture.texels).binary;
  if (!binary) glGenerateTextureMipmap(uploaded.texture.name());
  if (key.cut <= 0.0f) return;
  const MaskLevels mask = maskLevels(
      binary ? coveragePreservingMips(texture.texels, key.cut) : averagedLevels(texture.texels), key.cut, texture);
  uploaded.resolved = mask.resolved;
  for (std::size_t level = binary ? 1 : static_cast<std::size_t>(mask.resolved) + 1; level < mask.levels.size();
       ++level)
    uploadLevel(uploaded.texture, static_cast<GLint>(level),
                key.weighted ? weighted(mask.levels[level]) : mask.levels[level]);
  checkGl("uploading the mip levels of a mask");
}

void SceneTextures::bind(const Material& material, TextureFilter filter, float footprint) {
  const auto references = material.textures();
  for (std::size_t i = 0; i < references.size(); ++i) {
    const int index = references[i]->texture;
    if (index < 0) continue;
    const Key key = keyOf(material, i);
    Uploaded& uploaded = uploaded_.at(key);
    const pellucid::Texture& texture = scene_.textures[static_cast<std::size_t>(index)];
    if (filter == TextureFilter::mipmap && hasLevels(texture.minify) && !uploaded.mipmaps) makeMipmaps(key, uploaded);
    glBindTextureUnit(kUnits[i], uploaded.texture.name());
    glBindSampler(kUnits[i], samplerFor(texture, filter, footprint).name());
  }
}

}  // namespace pellucid::gl
