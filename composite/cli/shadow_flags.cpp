#include "composite/cli/shadow_flags.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <map>
#include <optional>

#include "composite/cli/particle_flags.h"
#include "composite/shadow_views.h"
#include "composite/shadows.h"
#include "engine_bridge/embree/surface_shadows.h"
#include "engine_bridge/gl/shadow_pass.h"
#include "engine_bridge/scene/blocks.h"
#include "engine_bridge/scene/opaque_planes.h"
#include "engine_bridge/scene/particle_grid.h"
#include "gbuffer/channels.h"
#include "gbuffer/errors.h"
#include "gbuffer/view_point.h"

namespace pellucid::cli {
namespace {

constexpr int kParticleTexels = 24;  // a particle's width: the tent has 15
constexpr int kOpaqueSize = 2048;    // texels along an edge of the maps that shadow transparent things

std::pair<std::string, std::string> nameAndLayer(const std::string& text) {
  const auto equals = text.find('=');
  if (equals == std::string::npos || equals == 0 || equals + 1 == text.size())
    throw UsageError(fmt::format("--light: found '{}', expected GLTFNAME=LAYER", text));
  return {text.substr(0, equals), text.substr(equals + 1)};
}

// R, G, B of a layer, or nothing. The layer's full name, or its end after a dot.
std::optional<Image<glm::vec3>> readLayer(const OpaqueFile& file, const std::string& layer) {
  const ExrPart& beauty = file.document.parts[static_cast<std::size_t>(file.choice.beautyPart)];
  std::string found;
  const ExrChannel* channels[3] = {};
  for (const NamedChannel& named : nameChannels(file.document)) {
    const bool ends = named.layerName.size() > layer.size() + 1 && named.layerName.ends_with("." + layer);
    if (named.layerName != layer && !ends) continue;
    const ExrPart& part = file.document.parts[static_cast<std::size_t>(named.part)];
    if (part.deep || !(part.data == beauty.data)) continue;
    const auto c = std::string("rgb").find(named.suffix);
    if (named.suffix.size() != 1 || c == std::string::npos) continue;
    if (!found.empty() && found != named.layerName)
      throw MeaningError(fmt::format("{}: --light: found layers '{}' and '{}', expected one that ends in '{}'",
                                     file.document.path, found, named.layerName, layer));
    found = named.layerName;
    channels[c] = named.channel;
  }
  if (!channels[0] || !channels[1] || !channels[2]) return std::nullopt;
  Image<glm::vec3> image(beauty.data.width(), beauty.data.height());
  for (std::size_t i = 0; i < image.size(); ++i)
    image[i] = glm::vec3(channels[0]->at(i), channels[1]->at(i), channels[2]->at(i));
  return image;
}

// What all lights together let through: each by the light it sends to a surface that faces it.
Image<glm::vec3> multiplierOf(const std::vector<std::size_t>& lights, const std::vector<Image<glm::vec3>>& visibility,
                              const Shot& shot) {
  const GBuffer& gbuffer = shot.opaque.gbuffer;
  Image<glm::vec3> result(gbuffer.data.width(), gbuffer.data.height(), glm::vec3(1.0f));
  for (int y = 0; y < result.height(); ++y)
    for (int x = 0; x < result.width(); ++x) {
      const float z = gbuffer.viewZ.at(x, y);
      if (!std::isfinite(z)) continue;
      const glm::dvec3 point = viewPoint(gbuffer, shot.camera, x, y);
      glm::vec3 arriving(0.0f), passed(0.0f);
      bool any = false;
      for (std::size_t k = 0; k < lights.size(); ++k) {
        const glm::vec3& v = visibility[k].at(x, y);
        any = any || v != glm::vec3(1.0f);
        const glm::vec3 sent =
            shading::arrivingAt(lightBlock(shot.scene.lights[lights[k]], shot.camera), glm::vec3(point)).irradiance;
        arriving += sent;
        passed += sent * v;
      }
      if (!any) continue;
      for (int c = 0; c < 3; ++c) result.at(x, y)[c] = arriving[c] > 0.0f ? passed[c] / arriving[c] : 1.0f;
    }
  return result;
}

ShadowMapSettings::Form formOf(const std::string& shadows) {
  using Form = ShadowMapSettings::Form;
  if (shadows == "stochastic:published") return Form::published;
  if (shadows == "stochastic:naive") return Form::naive;
  if (shadows == "stochastic:stratified") return Form::stratified;
  if (shadows == "stochastic:corrected") return Form::corrected;
  return Form::variance;
}

ShadowRays::Casters castersOf(const std::string& shadows) {
  return shadows == "exact:opaque" ? ShadowRays::Casters::opaque : ShadowRays::Casters::transparent;
}

std::shared_ptr<const ShadowMaps> drawMaps(const ShadowFlags& flags, const Shot& shot, std::uint32_t seed,
                                           GlContext& device) {
  ShadowMapSettings settings;
  settings.form = formOf(flags.shadows);
  settings.size = flags.sizeFor(shot.scene);
  settings.opaqueSize = std::min(settings.size, kOpaqueSize);
  settings.seed = seed;
  ShadowMapStatistics statistics;
  auto maps = std::make_shared<const ShadowMaps>(
      renderShadowMaps(device, shot.scene, shot.camera, &shot.opaque.gbuffer, settings, &statistics));
  spdlog::info("shadow maps of {0}x{0}: {1} faces, {2} MiB, drawn in {3:.2f} s, filtered in {4:.2f} s", settings.size,
               statistics.faces, statistics.bytes >> 20, statistics.drawSeconds, statistics.filterSeconds);
  return maps;
}

void writeViews(const std::string& path, const ShadowMaps& maps, const std::vector<Light>& lights) {
  const std::vector<std::string> shining = lightLayerNames(lights);
  std::vector<std::string> names;
  std::size_t next = 0;
  for (const Light& light : lights) names.push_back(shines(light) ? shining[next++] : std::string());
  const ShadowViews views = shadowViews(maps, names);
  if (views.layers.empty())
    throw MeaningError("--shadow-views: found nothing that casts into a map, expected a caster");
  say(writeLayers(path, views.window, views.window, views.layers));
}

ExtraLayer shadowLayer(const Image<glm::vec3>& multiplier) {
  ExtraLayer layer{"shadow", {}};
  for (int c = 0; c < 3; ++c) {
    Image<float> plane(multiplier.width(), multiplier.height());
    for (std::size_t i = 0; i < plane.size(); ++i) plane[i] = multiplier[i][c];
    layer.channels.emplace_back(std::string(1, "RGB"[c]), std::move(plane));
  }
  return layer;
}

}  // namespace

void ShadowFlags::addTo(CLI::App& verb) {
  verb.add_option("--shadows", shadows,
                  "Shadows of transparent things on the opaque picture and on each other, from the glTF's punctual "
                  "lights; exact: by "
                  "rays, one for each light and fragment; exact:opaque: as if what covers half hid all; stochastic: by "
                  "prefiltered maps; stochastic:published as printed; stochastic:naive, stratified, "
                  "corrected: maps without a filter, percentage closer")
      ->check(CLI::IsMember({"off", "exact", "exact:opaque", "stochastic", "stochastic:published", "stochastic:naive",
                             "stochastic:stratified", "stochastic:corrected"}))
      ->capture_default_str();
  sizeOption_ = verb.add_option("--shadow-size", size,
                                "Of --shadows stochastic: texels along an edge of a map as drawn, a multiple of 128; "
                                "prefiltered maps keep a quarter, faces of point lights have half; without it 4096, or "
                                "less where dense particles "
                                "alone cast, of which one is then 24 texels wide")
                    ->check(CLI::Range(128, 16384));
  verb.add_option("--light", lights,
                  "GLTFNAME=LAYER: the EXR layer with this light's part of the beauty; light.NAME is found by itself")
      ->allow_extra_args(false);
  verb.add_flag("--apply-shadows", apply,
                "Without such layers: multiply the beauty by the layer `shadow`, which is otherwise only written");
  verb.add_option(
      "--shadow-views", views,
      "Of --shadows stochastic: EXR to write what the maps hold to, for each light the casters' depth and what "
      "they hide; of stochastic:naive texel by texel");
}

int ShadowFlags::sizeFor(const Scene& scene) const {
  return sizeOption_ && sizeOption_->count() > 0 ? size : particleMapSize(scene, kParticleTexels, size);
}

void ShadowFlags::check() const {
  for (const std::string& text : lights) nameAndLayer(text);
  if (!on() && (!lights.empty() || apply))
    throw UsageError(
        fmt::format("{}: found it without --shadows, expected --shadows exact", apply ? "--apply-shadows" : "--light"));
  if (sizeOption_ && sizeOption_->count() > 0 && !mapped())
    throw UsageError(fmt::format("--shadow-size: --shadows {} draws no maps, expected stochastic", shadows));
  if (!views.empty() && !mapped())
    throw UsageError(fmt::format("--shadow-views: --shadows {} draws no maps, expected stochastic", shadows));
  if (size % 128 != 0) throw UsageError(fmt::format("--shadow-size: found {}, expected a multiple of 128", size));
}

ShadowResult castShadows(const ShadowFlags& flags, Shot& shot, int samples, std::uint32_t seed,
                         const std::function<GlContext&()>& device) {
  ShadowResult result;
  if (!flags.on()) return result;
  if (shot.deepOpaque)
    throw UsageError(
        "--shadows: found a deep picture, expected a flat one: its samples have no layers of single lights");
  const std::string& path = shot.opaque.document.path;
  std::map<std::string, std::string> wanted;
  for (const std::string& text : flags.lights) wanted.insert(nameAndLayer(text));
  std::vector<std::size_t> lit;
  std::string names;
  for (std::size_t i = 0; i < shot.scene.lights.size(); ++i) {
    if (!shines(shot.scene.lights[i])) continue;
    lit.push_back(i);
    names += (names.empty() ? "" : ", ") + shot.scene.lights[i].name;
  }
  if (lit.empty()) throw MeaningError("--shadows: found no punctual light in the glTF, expected one that shines");
  for (const auto& [name, layer] : wanted)
    if (std::none_of(lit.begin(), lit.end(),
                     [&, &wantedName = name](std::size_t i) { return shot.scene.lights[i].name == wantedName; }))
      throw MeaningError(fmt::format("--light: found no light '{}' in the glTF, expected one of {}", name, names));

  std::optional<ParticleShadows> particles;
  if (flags.exact())
    result.rays = std::make_shared<const ShadowRays>(shot.scene, shot.camera, castersOf(flags.shadows));
  else
    result.maps = drawMaps(flags, shot, seed, device());
  const ShadowRays* rays = result.rays.get();
  if (rays) particles.emplace(shot);
  if (!flags.views.empty()) writeViews(flags.views, *result.maps, shot.scene.lights);
  std::vector<Image<glm::vec3>> visibility, layers;
  std::vector<std::size_t> without;
  for (const std::size_t i : lit) {
    const std::string& name = shot.scene.lights[i].name;
    const auto found = wanted.find(name);
    const std::string layer = found == wanted.end() ? "light." + name : found->second;
    std::optional<Image<glm::vec3>> part = readLayer(shot.opaque, layer);
    if (!part && found != wanted.end())
      throw MeaningError(
          fmt::format("{}: --light {}={}: found no such layer with R, G and B in the beauty's window; it has {}", path,
                      name, layer, listNames(nameChannels(shot.opaque.document))));
    visibility.push_back(rays ? rays->visibility(i, shot.opaque.gbuffer, samples)
                              : mappedVisibility(*result.maps, i, shot.opaque.gbuffer, shot.camera, samples));
    if (rays) particles->dim(i, visibility.back());
    if (!part) without.push_back(i);
    layers.push_back(part ? std::move(*part) : Image<glm::vec3>());
  }
  GBuffer& gbuffer = shot.opaque.gbuffer;
  result.touched = Image<std::uint8_t>(gbuffer.data.width(), gbuffer.data.height(), 0);
  ShadowCounts counts;
  if (without.size() == lit.size()) {
    const Image<glm::vec3> multiplier = multiplierOf(lit, visibility, shot);
    result.layers.push_back(shadowLayer(multiplier));
    if (flags.apply) counts = darken(multiplier, gbuffer.beauty, result.touched);
    say({fmt::format(
        "{}: no layer of one light's part of the beauty; shadows are {} the layer `shadow` (--light "
        "NAME=LAYER says where they are)",
        path, flags.apply ? "multiplied onto everything, and written as" : "not applied, only written as")});
  } else {
    if (flags.apply)
      throw UsageError(
          "--apply-shadows: found layers of single lights, expected none: they are dimmed and summed again");
    std::vector<ShadowedLight> shadowed;
    for (std::size_t k = 0; k < lit.size(); ++k)
      if (!layers[k].empty()) shadowed.push_back({&visibility[k], &layers[k]});
    counts = relight(shadowed, gbuffer.beauty, result.touched);
    for (const std::size_t i : without)
      say({fmt::format("{}: light '{}' has no layer there: its shadow is left out (--light {}=LAYER)", path,
                       shot.scene.lights[i].name, shot.scene.lights[i].name)});
  }
  if (counts.clamped > 0)
    say({fmt::format("{}: at {} pixels the lights' layers hold more light than the beauty; shadows end at black there",
                     path, counts.clamped)});
  if (counts.nonFinite > 0)
    say({fmt::format("{}: {} pixels with light that is not finite keep it, unshadowed", path, counts.nonFinite)});
  return result;
}

std::shared_ptr<const SurfaceVisibility> surfaceLight(const ShadowResult& shadows, const Shot& shot) {
  if (!shadows.rays || !shot.hasScene) return nullptr;
  const bool lit = std::any_of(shot.scene.primitives.begin(), shot.scene.primitives.end(), [&](const Primitive& each) {
    const Material& material = shot.scene.materials[static_cast<std::size_t>(each.material)];
    return material.transparent() && !material.unlit && !isParticle(each, material);
  });
  if (!lit) return nullptr;
  const SurfaceVisibility surfaces = surfaceShadows(shot.scene, shot.camera, shot.opaque.gbuffer, shadows.rays);
  auto particles = std::make_shared<const ParticleShadows>(shot);
  const std::vector<PunctualLight> lights = lightBlocks(shot.scene.lights, shot.camera);
  return std::make_shared<const SurfaceVisibility>(
      [surfaces, particles, lights](std::size_t light, const glm::dvec3& point, std::uint32_t identity) {
        const glm::vec3 passed = surfaces(light, point, identity);
        return passed == glm::vec3(0.0f) ? passed : passed * particles->passed(lights[light], point);
      });
}

}  // namespace pellucid::cli
