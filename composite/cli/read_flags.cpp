#include "composite/cli/read_flags.h"

#include "composite/cli/number_checks.h"
#include "gbuffer/depth_kind.h"
#include "gbuffer/errors.h"
#include "gbuffer/producers.h"
#include "gbuffer/side_files.h"

namespace pellucid::cli {

void ReadFlags::addTo(CLI::App& verb, bool allViews) {
  verb.add_option("--preset", preset, "Who wrote the EXR; auto recognises it by header and channels")
      ->check(CLI::IsMember(presetChoices()))
      ->capture_default_str();
  verb.add_option("--beauty", beauty, "Layer of the beauty, such as ViewLayer.Combined");
  verb.add_option("--view", view,
                  std::string("View of a stereo picture, such as left") +
                      (allViews ? ", or all, each by its own camera" : "") + "; without it the first one")
      ->check([allViews](const std::string& text) -> std::string {
        return text != "all" || allViews ? "" : "--view: found all, expected one view: composite alone takes all";
      });
  verb.add_option("--depth", depth, "Channel of the depth, such as ViewLayer.Depth.Z, or FILE.exr[:CHANNEL] with it");
  verb.add_option("--aov", aovs, "NAME=FILE.exr: a pass in a file of its own; NAME is N, P, AO or light.LAMP")
      ->allow_extra_args(false);
  verb.add_option("--depth-kind", depthKind,
                  "What the depth means, of deep samples too: " + depthKindForms() +
                      "; without it what the preset says, else planar. auto is what the planes of the picture fit")
      ->check([](const std::string& text) -> std::string {
        try {
          parseDepthKind(text);
        } catch (const UsageError& error) {
          return error.what();
        }
        return "";
      });
  verb.add_option("--far", farValue, "Depth, in the file's unit, from which nothing was hit")->check(notBelowZero());
  verb.add_option("--unit", unit,
                  "Metres in one unit of the picture's depth, positions and camera, and of deep files; without it what "
                  "the preset says, else 1. --scene-unit is the glTF's")
      ->check(aboveZero());
}

ReadOptions ReadFlags::options() const {
  ReadOptions options;
  options.preset = preset;
  options.beautyLayer = beauty;
  options.view = view;
  options.depthFile = sideFileOf(depth);
  if (!options.depthFile) options.depthChannel = depth;
  for (const std::string& text : aovs) options.aovs.push_back(readAov(text));
  options.depthKind = depthKind;
  options.farValue = farValue;
  options.metresPerUnit = unit;
  return options;
}

}  // namespace pellucid::cli
