// The page of `inspect --html` and `view`: what a file holds, how it was understood, and what a scene adds to it.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "composite/compare/page.h"
#include "composite/look/plan_view.h"
#include "gbuffer/opaque_io.h"

namespace pellucid {

// Transparent things over the picture.
struct SceneLook {
  std::vector<ScenePart> parts;
  std::vector<std::string> lines;     // what came out, and what `composite` says
  std::vector<PageTable> tables;      // of the parts
  std::vector<PagePicture> pictures;  // what would be composited, and where
};

// A picture that a scene may be composited onto.
struct UnderstoodShot {
  const OpaqueFile* file = nullptr;
  std::optional<Camera> camera;
};

// Pictures of more than 16 million pixels together show every so many-th pixel of both axes, which the page says.
//   report      inspectionText() of the file
//   understood  nothing where the file is no G-buffer
//   scene       nothing where none was given
//   shown       how colours are shown
Page inspectPage(const ExrDocument& document, const std::string& report,
                 const std::optional<UnderstoodShot>& understood, const std::optional<SceneLook>& scene,
                 const DisplayShader& shown);

}  // namespace pellucid
