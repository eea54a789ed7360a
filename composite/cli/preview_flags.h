// Flags of a PNG beside the picture, as a display shows it, and of pages that show pictures so.
#pragma once
#include <CLI/CLI.hpp>
#include <string>

#include "composite/cli/colour_flags.h"
#include "composite/colour/display.h"
#include "composite/pipeline/request.h"
#include "gbuffer/exr_document.h"

namespace pellucid::cli {

// How a display shows pictures.
struct DisplayFlags {
  std::string display, viewTransform, look;
  double exposure = 0.0;
  //   of  what it is for: "--preview"
  void addDisplayTo(CLI::App& verb, const std::string& of);
  DisplayChoice choice() const { return {display, viewTransform, exposure, look}; }
  // The first of them that was given, or null.
  const char* given() const;
  // For a page, whose own stops are the exposure. Throws UsageError, and what ColourConfig::read throws.
  //   space  of the pictures
  DisplayShader shader(const ColourRequest& colour, const std::string& assetRoot, const ColourSpace& space) const;

 private:
  const CLI::Option* exposureOption_ = nullptr;
};

struct PreviewFlags : DisplayFlags {
  std::string file;
  void addTo(CLI::App& verb);
  bool wanted() const { return !file.empty(); }
  // What can be refused before any work. Throws UsageError, and what ColourConfig::read throws.
  //   forIt      the config serves the preview alone
  //   assetRoot  a folder whose files the config may name besides those under its own
  void check(const ColourRequest& colour, const std::string& assetRoot, bool forIt = false) const;
  // Writes it, where it is wanted.
  //   picture  as composited, in its own space; over black where it is not opaque
  void write(const ColourRequest& colour, const std::string& assetRoot, const ColourSpace& space,
             const Image<glm::vec4>& picture) const;
};

// Flags of a page whose pictures are shown so; the config is that of --ocio.
struct PageDisplayFlags : DisplayFlags {
  ColourFlags colour;
  //   page  the flag of the page: "--html"
  void addTo(CLI::App& verb, const std::string& page);
  // Throws UsageError for one that is given without the page, and what DisplayFlags::shader throws.
  void check(bool wanted) const;
  // Of a picture's colours, as its header states them.
  DisplayShader shaderOf(const ExrDocument& document) const;
};

}  // namespace pellucid::cli
