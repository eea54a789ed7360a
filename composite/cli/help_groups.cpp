#include "composite/cli/help_groups.h"

#include <memory>

#include "composite/cli/help_text.h"

namespace pellucid::cli {
namespace {

constexpr const char *kCommon = "Most used", *kInput = "Input", *kPicture = "Picture", *kMethod = "Method",
                     *kScattering = "Scattering", *kLight = "Light and shadow", *kAir = "Air", *kQuality = "Quality",
                     *kOutput = "Output", *kThresholds = "Thresholds", *kRunning = "Running";

// In the order in which a group lists them.
const std::vector<HelpRow> kRows{
    {"--output", kCommon, "FILE"},
    {"--camera", kCommon, "NAME"},
    {"--preset", kCommon, "PROGRAM"},
    {"--environment", kCommon, "FILE"},
    {"--set", kCommon, "NAME.KEY=VALUE"},
    {"--method", kCommon, "METHOD"},
    {"--aa", kCommon, "N"},
    {"--shadows", kCommon, "KIND"},
    {"--fog", kCommon, "KEY=VALUE,..."},
    {"--measure", kCommon, ""},
    {"--size", kInput, "WIDTHxHEIGHT"},
    {"--unit", kInput, "METRES"},
    {"--scene-unit", kInput, "METRES"},
    {"--asset-root", kInput, "FOLDER"},
    {"--held-out-by", kInput, "PLANES.exr"},
    {"--devices", kInput, ""},
    {"--layer-beauty", kInput, "LAYER"},
    {"--layer-depth", kInput, "CHANNEL"},
    {"--indirect", kInput, "LAYER"},
    {"--layer", kInput, "NAME"},
    {"--edges", kPicture, ""},
    {"--filter", kPicture, "SHAPE[:RADIUS]"},
    {"--beauty", kPicture, "LAYER"},
    {"--view", kPicture, "NAME"},
    {"--depth", kPicture, "CHANNEL|FILE.exr"},
    {"--aov", kPicture, "NAME=FILE.exr"},
    {"--depth-kind", kPicture, "KIND"},
    {"--far", kPicture, "DEPTH"},
    {"--working-space", kPicture, "NAME"},
    {"--ocio", kPicture, "CONFIG.ocio"},
    {"--methods", kMethod, "METHOD,..."},
    {"--precision", kMethod, ""},
    {"--weight", kMethod, "WEIGHT"},
    {"--weight-range", kMethod, "NEAR:FAR"},
    {"--weight-reference", kMethod, "METRES"},
    {"--weight-from", kMethod, "FILE.exr"},
    {"--normalisation", kMethod, ""},
    {"--self-modulation", kMethod, ""},
    {"--systems", kMethod, ""},
    {"--renderer", kMethod, ""},
    {"--samples", kMethod, "N"},
    {"--samples-adaptive", kMethod, "E"},
    {"--seed", kMethod, "N"},
    {"--masks", kMethod, ""},
    {"--correction", kMethod, ""},
    {"--inference", kMethod, ""},
    {"--refract", kScattering, "HOW"},
    {"--dispersion", kScattering, ""},
    {"--diffusion", kScattering, ""},
    {"--diffusion-scale", kScattering, "K0:K1"},
    {"--diffusion-kernel", kScattering, ""},
    {"--gather", kScattering, ""},
    {"--light", kLight, "NAME=LAYER"},
    {"--lumens-per-watt", kLight, "LUMENS"},
    {"--apply-shadows", kLight, ""},
    {"--shadow-size", kLight, "TEXELS"},
    {"--occlusion", kLight, ""},
    {"--occlusion-source", kLight, ""},
    {"--occlusion-inference", kLight, ""},
    {"--occlusion-direct", kLight, "SHARE"},
    {"--occlusion-radius", kLight, "METRES"},
    {"--source", kLight, ""},
    {"--radius", kLight, "METRES"},
    {"--direct", kLight, "SHARE"},
    {"--ao-radius", kLight, "METRES"},
    {"--fog-grid", kAir, "FILE.vdb[:GRID]"},
    {"--particle-light", kAir, "TEXELS"},
    {"--tolerance", kQuality, "E"},
    {"--low-res", kQuality, ""},
    {"--mask", kQuality, ""},
    {"--texture-filter", kQuality, ""},
    {"--no-prune", kQuality, ""},
    {"--layers", kOutput, "NAME,..."},
    {"--shadow-views", kOutput, "FILE.exr"},
    {"--preview", kOutput, "FILE.png"},
    {"--display", kOutput, "NAME"},
    {"--view-transform", kOutput, "NAME"},
    {"--exposure", kOutput, "STOPS"},
    {"--type", kOutput, ""},
    {"--html", kOutput, "FILE.html"},
    {"--fail", kThresholds, "DIFFERENCE"},
    {"--failrelative", kThresholds, "SHARE"},
    {"--failpercent", kThresholds, "PERCENT"},
    {"--hardfail", kThresholds, "DIFFERENCE"},
    {"--allowfailures", kThresholds, "PIXELS"},
    {"--warn", kThresholds, "DIFFERENCE"},
    {"--warnrelative", kThresholds, "SHARE"},
    {"--warnpercent", kThresholds, "PERCENT"},
    {"--hardwarn", kThresholds, "DIFFERENCE"},
    {"--metadata", kThresholds, ""},
    {"--ignore-attribute", kThresholds, "NAME"},
    {"--finite", kThresholds, ""},
    {"--resolve", kRunning, ""},
    {"--sampled-on", kRunning, ""},
    {"--order", kRunning, "ORDER"},
    {"--budget", kRunning, "BYTES"},
    {"--threads", kRunning, "N"},
    {"--device", kRunning, "N"},
    {"--explain", kRunning, ""},
    {"--stats", kRunning, ""},
    {"--json", kRunning, ""},
    {"--version", kRunning, ""},
    {"--help", kRunning, ""},
};

}  // namespace

const std::vector<std::string>& helpGroups() {
  static const std::vector<std::string> groups{kCommon, kInput,   kPicture, kMethod,     kScattering, kLight,
                                               kAir,    kQuality, kOutput,  kThresholds, kRunning};
  return groups;
}

const std::vector<HelpRow>& helpRows() {
  return kRows;
}

const HelpRow* helpRow(const std::string& flag) {
  for (const HelpRow& row : kRows)
    if (flag == row.flag) return &row;
  return nullptr;
}

void setUpHelp(CLI::App& app) {
  const auto text = std::make_shared<HelpText>();
  app.formatter(text);
  for (CLI::App* verb : app.get_subcommands([](CLI::App*) { return true; })) {
    verb->formatter(text);
    for (CLI::Option* option : verb->get_options())
      for (const std::string& name : option->get_lnames())
        if (const HelpRow* row = helpRow("--" + name)) option->group(row->group);
  }
}

}  // namespace pellucid::cli
