#include "composite/cli/preview_flags.h"

#include <fmt/format.h>

#include "composite/cli/messages.h"
#include "gbuffer/errors.h"

namespace pellucid::cli {
namespace {

ColourConfig configOf(const ColourRequest& colour, const std::string& assetRoot) {
  return colour.config.empty() ? ColourConfig::builtIn()
                               : ColourConfig::read(colour.config, colour.configBy, assetRoot);
}

}  // namespace

void PreviewFlags::addTo(CLI::App& verb) {
  verb.add_option("--preview", file, "PNG to write besides, as a display shows the picture");
  verb.add_option("--display", display, "Of --preview: display of the OpenColorIO config; without it the first one");
  verb.add_option("--view-transform", viewTransform,
                  "Of --preview: view of the display; without it the first one. The built-in config has sRGB, ACES SDR "
                  "and raw");
  verb.add_option("--look", look,
                  "Of --preview: look of the config, in the place of the view's own; the built-in config has none");
  exposureOption_ = verb.add_option("--exposure", exposure, "Of --preview: stops")->check(CLI::Range(-64.0, 64.0));
}

void PreviewFlags::check(const ColourRequest& colour, const std::string& assetRoot, bool forIt) const {
  if (wanted()) {
    checkDisplay(configOf(colour, assetRoot), choice());
    return;
  }
  const char* flag = !display.empty()               ? "--display"
                     : !viewTransform.empty()       ? "--view-transform"
                     : !look.empty()                ? "--look"
                     : exposureOption_->count() > 0 ? "--exposure"
                                                    : nullptr;
  if (!flag && forIt && !colour.config.empty() && colour.configBy == "--ocio") flag = "--ocio";
  if (flag)
    throw UsageError(
        fmt::format("{}: found it without --preview, expected --preview FILE.png: it says how that looks", flag));
}

void PreviewFlags::write(const ColourRequest& colour, const std::string& assetRoot, const ColourSpace& space,
                         const Image<glm::vec4>& picture) const {
  if (!wanted()) return;
  const DisplayTransform transform(configOf(colour, assetRoot), choice(), space);
  Image<glm::vec3> shown(picture.width(), picture.height());
  for (std::size_t i = 0; i < shown.size(); ++i) shown[i] = glm::vec3(picture[i]);
  transform.apply(shown);
  writePng(file, shown);
  note("{}: {}", file, transform.title());
}

}  // namespace pellucid::cli
