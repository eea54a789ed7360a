#include "composite/cli/shadow_flags.h"

#include <fmt/format.h>

#include "gbuffer/errors.h"

namespace pellucid::cli {
namespace {

std::pair<std::string, std::string> nameAndLayer(const std::string& text) {
  const auto equals = text.find('=');
  if (equals == std::string::npos || equals == 0 || equals + 1 == text.size())
    throw UsageError(fmt::format("--light: found '{}', expected GLTFNAME=LAYER", text));
  return {text.substr(0, equals), text.substr(equals + 1)};
}

// What --shadows takes, and what it means.
struct NamedShadows {
  const char* name;
  ShadowSource source;
  ShadowMapForm form;
};
constexpr NamedShadows kShadows[] = {
    {"off", ShadowSource::off, ShadowMapForm::variance},
    {"exact", ShadowSource::rays, ShadowMapForm::variance},
    {"exact:opaque", ShadowSource::raysOpaque, ShadowMapForm::variance},
    {"stochastic", ShadowSource::maps, ShadowMapForm::variance},
    {"stochastic:published", ShadowSource::maps, ShadowMapForm::published},
    {"stochastic:naive", ShadowSource::maps, ShadowMapForm::naive},
    {"stochastic:stratified", ShadowSource::maps, ShadowMapForm::stratified},
    {"stochastic:corrected", ShadowSource::maps, ShadowMapForm::corrected},
};

std::vector<std::string> shadowNames() {
  std::vector<std::string> names;
  for (const NamedShadows& each : kShadows) names.emplace_back(each.name);
  return names;
}

}  // namespace

void ShadowFlags::addTo(CLI::App& verb) {
  verb.add_option(
          "--shadows", shadows,
          "Shadows of transparent things and of fog on the opaque picture and on each other, from the glTF's punctual "
          "lights; exact: by "
          "rays, one for each light and fragment; exact:opaque: as if what covers half hid all; stochastic: by "
          "prefiltered maps; stochastic:published as printed; stochastic:naive, stratified, "
          "corrected: maps without a filter, percentage closer")
      ->check(CLI::IsMember(shadowNames()))
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

void ShadowFlags::into(Request& request) const {
  ShadowRequest& asked = request.shadows;
  for (const NamedShadows& each : kShadows)
    if (shadows == each.name) {
      asked.source = each.source;
      asked.form = each.form;
    }
  for (const std::string& text : lights) asked.layers.push_back(nameAndLayer(text));
  asked.apply = apply;
  asked.views = views;
  if (sizeOption_ && sizeOption_->count() > 0) asked.size = size;
}

}  // namespace pellucid::cli
