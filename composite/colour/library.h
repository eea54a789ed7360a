// What the files of this folder share of OpenColorIO. Included by them alone.
#pragma once
#include <OpenColorIO/OpenColorIO.h>

#include <string>

#include "composite/colour/config.h"

namespace pellucid {

namespace ocio = OCIO_NAMESPACE;

// A space of a config, and its primaries.
struct KnownSpace {
  std::string name;
  glm::dmat3 fromRec709{1.0};
};

struct ColourConfig::Impl {
  ocio::ConstConfigRcPtr config;
  std::string path;  // "" of the built-in one

  std::string title() const { return path.empty() ? "the built-in config" : path; }
  // By the role aces_interchange or by a name that is known, through which all others are reached. Throws MeaningError
  // where there is neither.
  KnownSpace known() const;
  // Nothing where light does not add up in the space.
  std::optional<ColourSpace> find(const ocio::ConstColorSpaceRcPtr& space) const;
};

// The built-in spaces, and a display for them.
ocio::ConstConfigRcPtr builtInConfig();
ocio::MatrixTransformRcPtr matrixTransform(const glm::dmat3& matrix);
std::string oneLine(const std::string& text);  // OpenColorIO's sentences end in lines of their own

}  // namespace pellucid
