// The colour space of a shot: the picture's, in which all arithmetic is.
#pragma once
#include "composite/colour/config.h"
#include "composite/pipeline/request.h"

namespace pellucid {

// Throws UsageError for a name that no file needs to be read for to know that there is no such space.
void checkColours(const ColourRequest& request);

class WorkingSpace {
 public:
  // Reads the config, where one is named. Throws what ColourConfig throws.
  //   assetRoot  a folder whose files the config may name besides those under its own
  WorkingSpace(const ColourRequest& request, const std::string& assetRoot);
  // By --working-space, else by the file's chromaticities, the config's rules for files, the preset, the config's rule
  // for all others.
  //   stated  what the file says of itself
  ColourSpace of(const ColourSpace& stated, const std::string& file, std::vector<std::string>& notes) const;

 private:
  std::optional<ColourConfig> config_;
  std::optional<ColourSpace> asked_;
};

}  // namespace pellucid
