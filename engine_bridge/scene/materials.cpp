#include "engine_bridge/scene/materials.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "engine_bridge/scene/set_keys.h"

namespace pellucid::gltf {

namespace {

constexpr float kMostRadiance = 1e15f;  // leaves room for products in float
constexpr float kMostDistance = 1e15f;
constexpr float kMostNormalScale = 1e3f;
constexpr float kMostIor = 100.0f;
constexpr float kMostDispersion = 100.0f;  // an Abbe number of .2; real glass has 20 to 90
constexpr float kReflectanceOfDefaultIor = 0.04f;
constexpr const char* kSpecularGlossiness = "KHR_materials_pbrSpecularGlossiness";
constexpr double kMirrorF0 = 0.999999;  // reflectance of an infinite index, as near as a finite one needs to come

struct MaterialReader {
  const GltfFile& file;
  const JsonView source;
  const bool used;
  TextureReader& textures;
  Notes& notes;
  Material& material;

  TextureRef texture(const JsonView& holder, const char* key, TexelUse use) const {
    const std::optional<JsonView> info = holder.find(key);
    return info ? textures.read(*info, use, material.name, used) : TextureRef{};
  }

  void note(const std::string& sentence) const { notes.add("material " + material.name + ": " + sentence); }

  void base() const {
    const std::string mode = source.string("alphaMode", "OPAQUE");
    if (mode == "MASK") {
      material.alphaMode = AlphaMode::mask;
    } else if (mode == "BLEND") {
      material.alphaMode = AlphaMode::blend;
    } else if (mode != "OPAQUE") {
      source.at("alphaMode").refuse(fmt::format("is {}; expected OPAQUE, MASK or BLEND", mode));
    }
    material.alphaCutoff = source.number("alphaCutoff", 0.5f, 0.0f, 1e6f, notes);  // above 1: nothing is left
    material.doubleSided = source.boolean("doubleSided", false);
    if (const std::optional<JsonView> pbr = source.find("pbrMetallicRoughness")) {
      material.baseColor = pbr->colourAlpha("baseColorFactor", glm::vec4(1.0f), 0.0f, 1.0f, notes);
      material.metallic = pbr->number("metallicFactor", 1.0f, 0.0f, 1.0f, notes);
      material.roughness = pbr->number("roughnessFactor", 1.0f, 0.0f, 1.0f, notes);
      material.baseColorTexture = texture(*pbr, "baseColorTexture", TexelUse::colour);
      material.metallicRoughnessTexture = texture(*pbr, "metallicRoughnessTexture", TexelUse::data);
    }
    if (source.find("occlusionTexture")) note("its occlusion texture is not used");
    material.emission = source.colour("emissiveFactor", glm::vec3(0.0f), 0.0f, 1.0f, notes);
    material.emissiveTexture = texture(source, "emissiveTexture", TexelUse::colour);
    if (const std::optional<JsonView> normals = source.find("normalTexture")) {
      material.normalTexture = texture(source, "normalTexture", TexelUse::data);
      material.normalScale = normals->number("scale", 1.0f, -kMostNormalScale, kMostNormalScale, notes);
    }
  }

  // KHR_materials_pbrSpecularGlossiness wins over what metallic and roughness say. Its reflectance head-on is a tint of
  // that of index 1.5, which rises as Schlick's term does.
  void specularGlossiness() const {
    const auto extension = source.extension(kSpecularGlossiness);
    if (!extension) return;
    material.baseColor = extension->colourAlpha("diffuseFactor", glm::vec4(1.0f), 0.0f, 1.0f, notes);
    material.baseColorTexture = texture(*extension, "diffuseTexture", TexelUse::colour);
    material.metallic = 0.0f;
    material.metallicRoughnessTexture = material.specularTexture = TextureRef{};
    material.ior = 1.5f;
    material.specular = 1.0f;
    material.specularColor =
        extension->colour("specularFactor", glm::vec3(1.0f), 0.0f, 1.0f, notes) / kReflectanceOfDefaultIor;
    material.specularColorTexture = texture(*extension, "specularGlossinessTexture", TexelUse::colour);
    const float glossiness = extension->number("glossinessFactor", 1.0f, 0.0f, 1.0f, notes);
    material.roughness = 1.0f - glossiness;
    if (const std::optional<JsonView> info = extension->find("specularGlossinessTexture")) {
      material.roughness = 1.0f;
      material.metallicRoughnessTexture = textures.readGlossy(*info, glossiness, material.name, used);
    }
  }

  // Light goes through what reflects and scatters; unlit colours do neither, whatever stands beside them.
  void unlit() const {
    material.unlit = source.extension("KHR_materials_unlit").has_value();
    if (!material.unlit || material.transmission <= 0.0f) return;
    material.transmission = 0.0f;
    note("is unlit, so its transmission is not used");
  }

  void emissiveStrength() const {
    if (const auto strength = source.extension("KHR_materials_emissive_strength")) {
      material.emission *= strength->number("emissiveStrength", 1.0f, 0.0f, kMostRadiance, notes);
    }
  }

  void transmission() const {
    const auto extension = source.extension("KHR_materials_transmission");
    if (!extension) return;
    material.transmission = extension->number("transmissionFactor", 0.0f, 0.0f, 1.0f, notes);
    material.transmissionTexture = texture(*extension, "transmissionTexture", TexelUse::data);
  }

  void indexOfRefraction() const {
    const auto extension = source.extension("KHR_materials_ior");
    const std::optional<JsonView> value = extension ? extension->find("ior") : std::nullopt;
    const bool infinite = value && value->number() == 0.0;
    if (value && !infinite) material.ior = extension->number("ior", 1.5f, 1.0f, kMostIor, notes);
    if (const auto specular = source.extension("KHR_materials_specular")) {
      material.specular = specular->number("specularFactor", 1.0f, 0.0f, 1.0f, notes);
      material.specularColor = specular->colour("specularColorFactor", glm::vec3(1.0f), 0.0f, kMostRadiance, notes);
      material.specularTexture = texture(*specular, "specularTexture", TexelUse::data);
      material.specularColorTexture = texture(*specular, "specularColorTexture", TexelUse::colour);
    }
    if (!infinite) return;
    // glTF's word for "the specular extension alone says what is reflected", an infinite index without it. The
    // dielectric of the same reflectance head-on stands for it.
    const glm::vec3 tint = material.specularColor;
    const double f0 = std::min(static_cast<double>(material.specular * std::max({tint.r, tint.g, tint.b})), kMirrorF0);
    const double root = std::sqrt(f0);
    material.ior = static_cast<float>((1.0 + root) / (1.0 - root));
    material.specular = 1.0f;
    material.specularColor = glm::vec3(1.0f);
    material.specularTexture = material.specularColorTexture = TextureRef{};
    note(fmt::format("ior 0 is taken as {:.6g}, which reflects as its specular factors say", material.ior));
  }

  void volume(double metresPerUnit) const {
    const auto extension = source.extension("KHR_materials_volume");
    if (!extension) return;
    material.thickness = extension->number("thicknessFactor", 0.0f, 0.0f, kMostDistance, notes);
    material.volume = material.thickness > 0.0f;
    material.thicknessTexture = texture(*extension, "thicknessTexture", TexelUse::data);
    material.attenuationColor = extension->colour("attenuationColor", glm::vec3(1.0f), 0.0f, 1.0f, notes);
    const std::optional<JsonView> distance = extension->find("attenuationDistance");
    if (!distance) return;
    const double metres = distance->number() * metresPerUnit;
    if (metres <= 0.0) distance->refuse(fmt::format("is {:g}; expected a distance above 0", distance->number()));
    // Beyond the largest it attenuates nothing that could be seen: the same as absent. Never 0, which means infinite.
    if (metres < static_cast<double>(kMostDistance))
      material.attenuationDistance = std::max(static_cast<float>(metres), 1e-30f);
  }

  void dispersion() const {
    const auto extension = source.extension("KHR_materials_dispersion");
    if (extension) material.dispersion = extension->number("dispersion", 0.0f, 0.0f, kMostDispersion, notes);
  }

  void diffuseTransmission() const {
    const auto extension = source.extension("KHR_materials_diffuse_transmission");
    if (!extension) return;
    material.diffuseTransmission = extension->number("diffuseTransmissionFactor", 0.0f, 0.0f, 1.0f, notes);
    const glm::vec3 tint = extension->colour("diffuseTransmissionColorFactor", glm::vec3(1.0f), 0.0f, 1.0f, notes);
    const bool textured =
        extension->find("diffuseTransmissionTexture") || extension->find("diffuseTransmissionColorTexture");
    if (textured || tint != glm::vec3(1.0f)) note("only the factor of its diffuse transmission is used");
  }

  void extras() const {
    const std::optional<JsonView> all = source.find("extras");
    if (!all || !all->isObject()) return;  // extras may be anything
    const std::optional<JsonView> ours = all->find("pellucid");
    if (!ours) return;
    for (const std::string& key : ours->keys()) {
      const JsonView value = ours->at(key.c_str());
      const SetResult result = setKey(material, key, value.scalarText());
      if (result == SetResult::badValue)
        value.refuse(fmt::format("is {}; the keys are {}", value.scalarText(), setKeyForms()));
      if (result == SetResult::unknownKey)
        note(fmt::format("extras.pellucid has no key {}; the keys are {}", key, setKeyForms()));
    }
  }
};

}  // namespace

Support supportFor(const std::string& extension) {
  using namespace std::string_view_literals;
  constexpr std::string_view kRead[] = {"EXT_mesh_gpu_instancing"sv,
                                        "EXT_meshopt_compression"sv,
                                        "EXT_texture_webp"sv,
                                        "KHR_animation_pointer"sv,
                                        "KHR_draco_mesh_compression"sv,
                                        "KHR_lights_punctual"sv,
                                        "KHR_materials_diffuse_transmission"sv,
                                        "KHR_materials_dispersion"sv,
                                        "KHR_materials_emissive_strength"sv,
                                        "KHR_materials_ior"sv,
                                        "KHR_materials_pbrSpecularGlossiness"sv,
                                        "KHR_materials_specular"sv,
                                        "KHR_materials_transmission"sv,
                                        "KHR_materials_unlit"sv,
                                        "KHR_materials_volume"sv,
                                        "KHR_mesh_quantization"sv,
                                        "KHR_node_visibility"sv,
                                        "KHR_texture_transform"sv};
  constexpr std::string_view kHarmless[] = {"KHR_xmp"sv, "KHR_xmp_json_ld"sv, "KHR_materials_variants"sv};
  if (std::find(std::begin(kRead), std::end(kRead), extension) != std::end(kRead)) return Support::full;
  if (std::find(std::begin(kHarmless), std::end(kHarmless), extension) != std::end(kHarmless)) return Support::harmless;
  return Support::none;
}

Material readMaterial(const GltfFile& file, std::size_t index, double metresPerUnit, bool used, TextureReader& textures,
                      Notes& notes) {
  Material material;
  const JsonView source = file.item("materials", index);
  material.name = source.string("name", "");
  if (material.name.empty()) material.name = fmt::format("material_{}", index);
  const MaterialReader reader{file, source, used, textures, notes, material};
  reader.base();
  reader.emissiveStrength();
  reader.transmission();
  reader.indexOfRefraction();
  reader.specularGlossiness();
  reader.volume(metresPerUnit);
  reader.dispersion();
  reader.diffuseTransmission();
  reader.unlit();
  reader.extras();
  return material;
}

Material defaultMaterial() {
  Material material;
  material.name = "default";
  return material;
}

}  // namespace pellucid::gltf
