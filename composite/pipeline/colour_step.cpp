#include "composite/pipeline/colour_step.h"

#include <fmt/format.h>

#include "gbuffer/errors.h"

namespace pellucid {
namespace {

bool isAuto(const ColourRequest& request) {
  return request.workingSpace == "auto";
}

ColourSpace builtInSpace(const std::string& name) {
  const NamedSpace* row = namedSpace(name);
  if (!row)
    throw UsageError(
        fmt::format("--working-space: found '{}', expected auto, {}, or a name of a config that --ocio "
                    "gives",
                    name, spaceNames()));
  ColourSpace space = *spaceOf(row->chromaticities);
  space.source = SpaceSource::flag;
  return space;
}

}  // namespace

void checkColours(const ColourRequest& request) {
  if (request.config.empty() && !isAuto(request)) builtInSpace(request.workingSpace);
}

WorkingSpace::WorkingSpace(const ColourRequest& request, const std::string& assetRoot) {
  if (!request.config.empty()) config_ = ColourConfig::read(request.config, request.configBy, assetRoot);
  if (!isAuto(request)) asked_ = config_ ? config_->space(request.workingSpace) : builtInSpace(request.workingSpace);
}

ColourSpace WorkingSpace::of(const ColourSpace& stated, const std::string& file,
                             std::vector<std::string>& notes) const {
  if (asked_) return *asked_;
  if (stated.source == SpaceSource::chromaticities || !config_) return stated;
  std::optional<ColourSpace> ruled;
  try {
    ruled = config_->spaceOfFile(file);
  } catch (const MeaningError& error) {
    notes.push_back(fmt::format("{}; its file rules are not taken", error.what()));
  }
  if (!ruled || (ruled->source == SpaceSource::defaultRule && stated.source == SpaceSource::preset)) return stated;
  return *ruled;
}

}  // namespace pellucid
