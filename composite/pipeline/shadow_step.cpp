#include "composite/pipeline/shadow_step.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "composite/pipeline/air.h"
#include "composite/pipeline/deep_shadows.h"
#include "composite/shadow_views.h"
#include "composite/shadows.h"
#include "engine_bridge/gl/shadow_pass.h"
#include "engine_bridge/scene/opaque_planes.h"
#include "engine_bridge/scene/particle_grid.h"
#include "gbuffer/channels.h"
#include "gbuffer/errors.h"
#include "gbuffer/view_point.h"

namespace pellucid {
namespace {

constexpr int kParticleTexels = 24;  // a particle's width: the tent has 15
constexpr int kOpaqueSize = 2048;    // texels along an edge of the maps that shadow transparent things
constexpr int kSizeUnit = 128;       // texels that a map's edge is a multiple of
constexpr int kDefaultSize = 4096;   // texels

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

ShadowMapSettings::Form formOf(ShadowMapForm form) {
  using Form = ShadowMapSettings::Form;
  switch (form) {
    case ShadowMapForm::published:
      return Form::published;
    case ShadowMapForm::naive:
      return Form::naive;
    case ShadowMapForm::stratified:
      return Form::stratified;
    case ShadowMapForm::corrected:
      return Form::corrected;
    case ShadowMapForm::variance:
      break;
  }
  return Form::variance;
}

std::shared_ptr<const ShadowMaps> drawMaps(const ShadowRequest& request, const Shot& shot, Device& device,
                                           Journal& journal) {
  ShadowMapSettings settings;
  settings.form = formOf(request.form);
  settings.size = request.size.value_or(particleMapSize(shot.scene, kParticleTexels, kDefaultSize));
  settings.opaqueSize = std::min(settings.size, kOpaqueSize);
  settings.seed = request.seed;
  ShadowMapStatistics statistics;
  auto maps = std::make_shared<const ShadowMaps>(
      renderShadowMaps(device.context(journal), shot.scene, shot.camera, &shot.opaque.gbuffer, settings, &statistics));
  journal.note(fmt::format("shadow maps of {0}x{0}: {1} faces, {2} MiB, drawn in {3:.2f} s, filtered in {4:.2f} s",
                           settings.size, statistics.faces, statistics.bytes >> 20, statistics.drawSeconds,
                           statistics.filterSeconds));
  return maps;
}

void writeViews(const std::string& path, const ShadowMaps& maps, const std::vector<Light>& lights, Journal& journal) {
  const std::vector<std::string> shining = lightLayerNames(lights);
  std::vector<std::string> names;
  std::size_t next = 0;
  for (const Light& light : lights) names.push_back(shines(light) ? shining[next++] : std::string());
  const ShadowViews views = shadowViews(maps, names);
  if (views.layers.empty())
    throw MeaningError("--shadow-views: found nothing that casts into a map, expected a caster");
  journal.note(writeLayers(path, views.window, views.window, views.layers));
}

// The lights that shine, and the layers that were named for them.
struct ShiningLights {
  std::vector<std::size_t> numbers;  // into Scene::lights
  std::map<std::string, std::string> wanted;
};

ShiningLights lightsOf(const ShadowRequest& request, const Shot& shot) {
  ShiningLights lights;
  lights.wanted.insert(request.layers.begin(), request.layers.end());
  std::string names;
  for (std::size_t i = 0; i < shot.scene.lights.size(); ++i) {
    if (!shines(shot.scene.lights[i])) continue;
    lights.numbers.push_back(i);
    names += (names.empty() ? "" : ", ") + shot.scene.lights[i].name;
  }
  if (lights.numbers.empty())
    throw MeaningError("--shadows: found no punctual light in the glTF, expected one that shines");
  for (const auto& [name, layer] : lights.wanted)
    if (std::none_of(lights.numbers.begin(), lights.numbers.end(),
                     [&, &wantedName = name](std::size_t i) { return shot.scene.lights[i].name == wantedName; }))
      throw MeaningError(fmt::format("--light: found no light '{}' in the glTF, expected one of {}", name, names));
  return lights;
}

// Multiplies the whole beauty, or only writes the layer `shadow`.
ShadowCounts darkenWhole(const ShadowRequest& request, const Image<glm::vec3>& multiplier, const Shot& shot,
                         CastShadows& result, Journal& journal) {
  ShadowCounts counts;
  result.layer = multiplier;
  if (request.apply) {
    result.beauty = shot.opaque.gbuffer.beauty;
    counts = darken(multiplier, result.beauty, result.touched);
  }
  journal.note(
      fmt::format("{}: no layer of one light's part of the beauty; shadows are {} the layer `shadow` (--light "
                  "NAME=LAYER says where they are)",
                  shot.opaque.document.path,
                  request.apply ? "multiplied onto everything, and written as" : "not applied, only written as"));
  return counts;
}

// Each light's part of the picture and what passes the transparent things of it.
void shadowFlatPicture(const ShadowRequest& request, const ShiningLights& lights, const Shot& shot, int samples,
                       const AirBetween& air, CastShadows& result, Journal& journal) {
  const std::string& path = shot.opaque.document.path;
  const GBuffer& gbuffer = shot.opaque.gbuffer;
  const ShadowRays* rays = result.rays.get();
  std::vector<Image<glm::vec3>> visibility, layers;
  std::vector<std::size_t> without;
  for (const std::size_t i : lights.numbers) {
    const std::string& name = shot.scene.lights[i].name;
    const auto found = lights.wanted.find(name);
    const bool named = found != lights.wanted.end();
    const std::string layer = named ? found->second : "light." + name;
    std::optional<Image<glm::vec3>> part = readLayer(shot.opaque, layer);
    if (!part && named)
      throw MeaningError(
          fmt::format("{}: --light {}={}: found no such layer with R, G and B in the beauty's window; it has {}", path,
                      name, layer, listNames(nameChannels(shot.opaque.document))));
    const AirPassed passed = air.bySample(i);
    visibility.push_back(rays ? rays->visibility(i, gbuffer, samples, passed)
                              : mappedVisibility(*result.maps, i, gbuffer, shot.camera, samples, passed));
    air.dimByGrids(i, visibility.back());
    if (!part) without.push_back(i);
    layers.push_back(part ? std::move(*part) : Image<glm::vec3>());
  }
  result.touched = Image<std::uint8_t>(gbuffer.data.width(), gbuffer.data.height(), 0);
  ShadowCounts counts;
  if (without.size() == lights.numbers.size()) {
    counts = darkenWhole(request, multiplierOf(lights.numbers, visibility, shot), shot, result, journal);
  } else {
    if (request.apply)
      throw UsageError(
          "--apply-shadows: found layers of single lights, expected none: they are dimmed and summed again");
    std::vector<ShadowedLight> shadowed;
    for (std::size_t k = 0; k < layers.size(); ++k)
      if (!layers[k].empty()) shadowed.push_back({&visibility[k], &layers[k]});
    result.beauty = gbuffer.beauty;
    counts = relight(shadowed, result.beauty, result.touched);
    for (const std::size_t i : without)
      journal.note(fmt::format("{}: light '{}' has no layer there: its shadow is left out (--light {}=LAYER)", path,
                               shot.scene.lights[i].name, shot.scene.lights[i].name));
  }
  if (counts.clamped > 0)
    journal.note(
        fmt::format("{}: at {} pixels the lights' layers hold more light than the beauty; shadows end at black there",
                    path, counts.clamped));
  if (counts.nonFinite > 0)
    journal.note(
        fmt::format("{}: {} pixels with light that is not finite keep it, unshadowed", path, counts.nonFinite));
}

// A deep picture has no layers of single lights: its samples are multiplied, or the layer `shadow` is written.
void shadowDeepPicture(const ShadowRequest& request, const ShiningLights& lights, const Shot& shot,
                       const AirBetween& air, CastShadows& result, Journal& journal) {
  if (!request.layers.empty())
    throw MeaningError(
        fmt::format("{}: --light: found a deep picture, whose samples have no layers of single lights; "
                    "expected --apply-shadows",
                    shot.opaque.document.path));
  const DeepVisibility visible = [&](std::size_t light, const glm::dvec3& point) {
    const glm::vec3 passed =
        result.rays ? result.rays->visibility(light, point) : result.maps->onOpaque(light, glm::vec3(point));
    return air.clear() ? passed : passed * air.passed(lightBlock(shot.scene.lights[light], shot.camera), point);
  };
  DeepShadows dimmed = dimDeepPicture(shot, lights.numbers, visible);
  result.layer = dimmed.multiplier;
  result.touched = Image<std::uint8_t>(dimmed.multiplier.width(), dimmed.multiplier.height(), 0);
  if (request.apply) {
    result.touched = std::move(dimmed.touched);
    result.deepOpaque = std::make_unique<DeepOpaque>(std::move(dimmed.picture));
    result.beauty = result.deepOpaque->flat;
  }
  journal.note(
      fmt::format("{}: a deep picture has no layer of one light's part; shadows are {} the layer `shadow`",
                  shot.opaque.document.path,
                  request.apply ? "multiplied onto its samples, and written as" : "not applied, only written as"));
}

}  // namespace

void checkShadows(const ShadowRequest& request) {
  if (!request.on() && (!request.layers.empty() || request.apply))
    throw UsageError(fmt::format("{}: found it without --shadows, expected --shadows exact",
                                 request.apply ? "--apply-shadows" : "--light"));
  if (request.size && !request.byMaps())
    throw UsageError("--shadow-size: found it without --shadows stochastic, which alone draws maps");
  if (!request.views.empty() && !request.byMaps())
    throw UsageError("--shadow-views: found it without --shadows stochastic, which alone draws maps");
  if (request.size && *request.size % kSizeUnit != 0)
    throw UsageError(fmt::format("--shadow-size: found {}, expected a multiple of {}", *request.size, kSizeUnit));
}

CastShadows castShadows(const ShadowRequest& request, const Shot& shot, std::shared_ptr<const Fog> fog, int samples,
                        Device& device, Journal& journal) {
  CastShadows result;
  if (!request.on()) return result;
  const ShiningLights lights = lightsOf(request, shot);
  if (request.byRays())
    result.rays = std::make_shared<const ShadowRays>(
        shot.scene, shot.camera,
        request.source == ShadowSource::raysOpaque ? ShadowRays::Casters::opaque : ShadowRays::Casters::transparent);
  else
    result.maps = drawMaps(request, shot, device, journal);
  if (!request.views.empty()) writeViews(request.views, *result.maps, shot.scene.lights, journal);
  const AirBetween air(shot, std::move(fog), request.byRays());
  if (shot.deepOpaque)
    shadowDeepPicture(request, lights, shot, air, result, journal);
  else
    shadowFlatPicture(request, lights, shot, samples, air, result, journal);
  return result;
}

}  // namespace pellucid
