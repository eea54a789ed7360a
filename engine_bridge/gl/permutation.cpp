#include "engine_bridge/gl/permutation.h"

#include "engine_bridge/gl/frame_blocks.h"
#include "shaders/plane_defines.h"

namespace pellucid::gl {

void Needs::addScattering(const Material& material) {
  refracts = refracts || pellucid::refracts(material);
  diffuses = diffuses || pellucid::diffuses(material);
  disperses = disperses || pellucid::disperses(material);
}

Needs either(const Needs& a, const Needs& b) {
  return {a.solids || b.solids,       a.adds || b.adds,         a.refracts || b.refracts, a.diffuses || b.diffuses,
          a.disperses || b.disperses, a.coloured || b.coloured, a.infers || b.infers};
}

void chooseScattering(const Needs& needs, const PassSettings& settings, FrameFeatures& frame) {
  const bool all = !settings.scatter.prune;
  frame.refracts = settings.scatter.refract != shading::PLD_REFRACT_OFF && (needs.refracts || all);
  frame.disperses = frame.refracts && settings.scatter.dispersion && (needs.disperses || all);
  const bool fogDiffuses = settings.fog && settings.fog->diffuses();
  frame.diffuses = (settings.scatter.k0 > 0.0f && (needs.diffuses || all)) || fogDiffuses;
}

void scatterNothing(FrameFeatures& frame) {
  frame.refracts = frame.diffuses = frame.disperses = false;
}

std::vector<std::string> leftOut(const FrameFeatures& frame, const PassSettings& settings, bool wouldOcclude) {
  const LayerModel layers = layersOf(frame, settings);
  std::vector<std::string> reasons;
  const auto plane = [&](bool kept, const char* name, const char* reason) {
    if (!kept) reasons.push_back(std::string(name) + ": " + reason);
  };
  if (!layers.published()) {
    plane(layers.coloured, "coloured opacity", "no material transmits colour");
    plane(holds(layers, PlaneSum::light), "additive light", "no material adds light or transmits");
  }
  plane(frame.solids, "solid pass", "no fragment can hide everything");
  // Read like the picture's own planes, not written.
  plane(frame.occludes, "inferred occlusion",
        wouldOcclude ? "switched off" : "no cut-out material, or no surroundings");
  plane(layers.scatters(), "scattering planes", "nothing refracts or diffuses");
  plane(
      frame.refracts, "refraction",
      settings.scatter.refract == shading::PLD_REFRACT_OFF ? "switched off" : "no material transmits through a volume");
  plane(layers.disperses, "dispersion",
        layers.published()            ? "the published targets hold one offset for all channels"
        : settings.scatter.dispersion ? "no refracting material disperses"
                                      : "switched off");
  plane(frame.diffuses, "diffusion",
        settings.scatter.k0 > 0.0f ? "no material has a collimation below 1" : "switched off");
  return reasons;
}

std::vector<std::string> surfaceDefines(const Material& material, bool vertexColours, const FrameFeatures& frame,
                                        bool infers, bool points) {
  std::vector<std::string> defines;
  auto define = [&defines](const char* name, bool wanted) {
    if (wanted) defines.emplace_back(name);
  };
  const bool lit = !material.unlit;
  define("UNLIT", material.unlit);
  define("LIGHTS", lit && frame.lights);
  define("SHADOWS", lit && frame.lights && frame.shadows);
  const bool particle = lit && (points || material.billboard);
  define("SHADOW_RAYS", lit && !particle && frame.lights && frame.shadowRays);
  define("SURROUNDINGS", lit && frame.surroundings);
  define("ENVIRONMENT", lit && frame.environment);
  define("VERTEX_COLOUR", vertexColours);
  define("BLEND", material.alphaMode == AlphaMode::blend);
  define("MASK_SMOOTH", material.alphaMode == AlphaMode::mask && frame.mask == MaskEdge::smooth);
  define("MASK_HARD", material.alphaMode == AlphaMode::mask && frame.mask == MaskEdge::hard);
  const bool transmits = material.transmission > 0.0f;
  define("BASE_TEXTURE", material.baseColorTexture.texture >= 0);
  define("METALLIC_ROUGHNESS_TEXTURE", lit && material.metallicRoughnessTexture.texture >= 0);
  define("NORMAL_TEXTURE", lit && material.normalTexture.texture >= 0);
  define("SPECULAR_TEXTURE", lit && material.specularTexture.texture >= 0);
  define("SPECULAR_COLOUR_TEXTURE", lit && material.specularColorTexture.texture >= 0);
  define("EMISSIVE_TEXTURE", lit && material.emissiveTexture.texture >= 0 && material.emission != glm::vec3(0.0f));
  define("TRANSMISSION_TEXTURE", transmits && material.transmissionTexture.texture >= 0);
  define("VOLUME", transmits && hasVolume(material));
  define("THICKNESS_TEXTURE", transmits && hasVolume(material) && material.thicknessTexture.texture >= 0);
  define("POINTS", points);
  define("SOFT", material.softness > 0.0f && !points);
  define("PARTICLE", particle);
  define("LIGHT_VOLUME", particle && frame.lights && frame.lightVolume);
  const bool bends = frame.refracts && (refracts(material) || !frame.prune);
  define("REFRACTS", bends);
  define("REFRACTION_TEXTURE", bends && material.thicknessTexture.texture >= 0);
  define("DISPERSES", bends && frame.disperses && (disperses(material) || !frame.prune));
  define("DIFFUSES", frame.diffuses && (diffuses(material) || !frame.prune));
  const bool occluded = frame.occludes && infers && !particle;
  define("OCCLUDED", occluded);
  if (occluded && frame.rimForm >= 0) defines.push_back("RIM_FORM " + std::to_string(frame.rimForm));
  return defines;
}

LayerModel layersOf(const FrameFeatures& frame, const SumsSettings& sums) {
  LayerModel model;
  model.tier = sums.tier == SumsTier::published ? PlaneTier::published : PlaneTier::float32;
  model.weight = sums.weight.kind;
  model.normalisation = sums.normalisation;
  model.coloured = !frame.grey;
  model.addsLight = frame.adds || !frame.prune;
  model.refracts = frame.refracts;
  model.diffuses = frame.diffuses;
  model.disperses = frame.disperses && !model.published();
  model.solids = frame.solids;
  return model;
}

std::vector<std::string> outputDefines(Output output, const FrameFeatures& frame, const SumsSettings& sums) {
  std::vector<std::string> defines;
  const auto write = [&](const char* name, SumsTier tier, PlaneStage stage) {
    SumsSettings ofTier = sums;
    ofTier.tier = tier;
    defines = writeDefines(layersOf(frame, ofTier), stage);
    defines.emplace_back(name);
  };
  switch (output) {
    case Output::sums:
      write("OUTPUT_SUMS", SumsTier::float32, PlaneStage::layers);
      break;
    case Output::published:
      write("OUTPUT_PUBLISHED", SumsTier::published, PlaneStage::layers);
      break;
    case Output::rims:
      write("OUTPUT_RIMS", SumsTier::float32, PlaneStage::rims);
      break;
    case Output::count:
      defines = {"OUTPUT_COUNT"};
      break;
    case Output::list:
      defines = {"OUTPUT_LIST"};
      break;
    case Output::leanList:
      defines = {"OUTPUT_LIST", "LEAN"};
      break;
    case Output::cover:
    case Output::coverToWin:
      defines = {"OUTPUT_COVER"};
      break;
    case Output::claim:
      defines = {"OUTPUT_CLAIM"};
      break;
    case Output::add:
    case Output::addWon:
      defines = {"OUTPUT_ADD"};
      break;
    case Output::solid:
      write("OUTPUT_SOLID", SumsTier::float32, PlaneStage::solids);
      defines.emplace_back("EXACT_COVERAGE");
      return defines;
  }
  const bool winners = output == Output::coverToWin || output == Output::claim || output == Output::addWon;
  if (winners) defines.emplace_back("WINNERS");
  const bool samples = winners || output == Output::cover || output == Output::add;
  if (samples && frame.grey) defines.emplace_back("GREY");
  defines.emplace_back("EXACT_COVERAGE");
  if (frame.pieces && (samples || output == Output::list)) defines.emplace_back("PIECES");
  if (frame.solids) defines.emplace_back("SOLIDS");
  if (samples) return defines;  // what scatters is summed apart
  const bool lists = output == Output::list || output == Output::leanList;
  if (frame.probes && (output == Output::count || lists)) defines.emplace_back("PROBES");
  if (output != Output::list) return defines;
  if (frame.scatters()) defines.emplace_back("SCATTER");
  if (frame.disperses) defines.emplace_back("DISPERSION");
  return defines;
}

}  // namespace pellucid::gl
