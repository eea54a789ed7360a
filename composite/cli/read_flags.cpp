#include "composite/cli/read_flags.h"

#include "gbuffer/depth_kind.h"
#include "gbuffer/errors.h"
#include "gbuffer/producers.h"

namespace pellucid::cli {

void ReadFlags::addTo(CLI::App& verb) {
  verb.add_option("--preset", preset, "Who wrote the EXR; auto recognises it by header and channels")
      ->check(CLI::IsMember(presetChoices()))
      ->capture_default_str();
  verb.add_option("--beauty", beauty, "Layer of the beauty, such as ViewLayer.Combined");
  verb.add_option("--view", view, "View of a stereo picture, such as left; without it the first one");
  verb.add_option("--depth", depth, "Channel of the depth, such as ViewLayer.Depth.Z");
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
  verb.add_option("--far", farValue, "Depth, in the file's unit, from which nothing was hit");
  verb.add_option("--unit", unit,
                  "Metres in one unit of the picture's depth, positions and camera, and of deep files; without it what "
                  "the preset says, else 1. --scene-unit is the glTF's")
      ->check(CLI::PositiveNumber);
}

ReadOptions ReadFlags::options() const {
  ReadOptions options;
  options.preset = preset;
  options.beautyLayer = beauty;
  options.view = view;
  options.depthChannel = depth;
  options.depthKind = depthKind;
  options.farValue = farValue;
  options.metresPerUnit = unit;
  return options;
}

}  // namespace pellucid::cli
