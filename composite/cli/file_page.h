// The page that shows what an EXR holds, for `inspect --html` and `view`.
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "composite/cli/preview_flags.h"
#include "composite/pipeline/request.h"

namespace pellucid::cli {

//   report  inspectExr() of the file
//   scenes  glTF and deep EXR to show over it; empty: none
//   shown   how colours are shown
// Throws what readers throw, ResourceError when the page cannot be written, and with scenes what Compositor throws.
void writeFilePage(const std::string& page, const std::string& file, const nlohmann::json& report,
                   const ReadOptions& read, const std::vector<std::string>& scenes = {},
                   const CameraChoice& camera = {}, const PageDisplayFlags& shown = {});

}  // namespace pellucid::cli
