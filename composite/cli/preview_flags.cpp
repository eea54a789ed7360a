#include "composite/cli/preview_flags.h"

#include <fmt/format.h>

#include <algorithm>

#include "composite/cli/messages.h"
#include "composite/cli/number_checks.h"
#include "composite/pipeline/colour_step.h"
#include "gbuffer/errors.h"

namespace pellucid::cli {
namespace {

ColourConfig configOf(const ColourRequest& colour, const std::string& assetRoot) {
  return colour.config.empty() ? ColourConfig::builtIn()
                               : ColourConfig::read(colour.config, colour.configBy, assetRoot);
}

}  // namespace

void DisplayFlags::addDisplayTo(CLI::App& verb, const std::string& of) {
  verb.add_option("--display", display,
                  fmt::format("Of {}: display of the OpenColorIO config; without it the first one", of));
  verb.add_option("--view-transform", viewTransform,
                  fmt::format("Of {}: view of the display; without it the first one. The built-in config has sRGB, "
                              "ACES SDR and raw",
                              of));
  verb.add_option(
      "--look", look,
      fmt::format("Of {}: look of the config, in the place of the view's own; the built-in config has none", of));
  exposureOption_ = verb.add_option("--exposure", exposure, fmt::format("Of {}: stops", of))
                        ->check(CLI::Range(-64.0, 64.0))
                        ->check(isNumber());
}

const char* DisplayFlags::given() const {
  return !display.empty()               ? "--display"
         : !viewTransform.empty()       ? "--view-transform"
         : !look.empty()                ? "--look"
         : exposureOption_->count() > 0 ? "--exposure"
                                        : nullptr;
}

DisplayShader DisplayFlags::shader(const ColourRequest& request, const std::string& assetRoot,
                                   const ColourSpace& space) const {
  DisplayChoice plain = choice();
  plain.exposure = 0.0;
  return DisplayTransform(configOf(request, assetRoot), plain, space).shader();
}

void PageDisplayFlags::addTo(CLI::App& verb, const std::string& page) {
  colour.addConfigTo(verb, page);
  addDisplayTo(verb, page);
}

void PageDisplayFlags::check(bool wanted) const {
  if (wanted) {
    checkDisplay(configOf(colour.request(), colour.assetRoot), choice());
    return;
  }
  const char* flag = !colour.config.empty() ? "--ocio" : !colour.assetRoot.empty() ? "--asset-root" : given();
  if (flag)
    throw UsageError(fmt::format(
        "{}: found it without --html, expected --html FILE.html: it says how the page shows pictures", flag));
}

DisplayShader PageDisplayFlags::shaderOf(const ExrDocument& document) const {
  std::vector<std::string> notes;
  const auto flat = std::find_if(document.parts.begin(), document.parts.end(),
                                 [](const ExrPart& part) { return part.attributes.contains("chromaticities"); });
  const ExrPart& part = flat == document.parts.end() ? document.parts.front() : *flat;
  const WorkingSpace space(colour.request(), colour.assetRoot);
  return shader(colour.request(), colour.assetRoot, space.of(statedSpace(part, "", notes), document.path, notes));
}

void PreviewFlags::addTo(CLI::App& verb) {
  verb.add_option("--preview", file, "PNG to write besides, as a display shows the picture");
  addDisplayTo(verb, "--preview");
}

void PreviewFlags::check(const ColourRequest& colour, const std::string& assetRoot, bool forIt) const {
  if (wanted()) {
    checkDisplay(configOf(colour, assetRoot), choice());
    return;
  }
  const char* flag = given();
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
