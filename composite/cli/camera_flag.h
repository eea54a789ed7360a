// What --camera and --environment say.
#pragma once
#include <string>
#include <vector>

#include "composite/pipeline/request.h"

namespace pellucid::cli {

// The camera of a view, by its own entry or by the one for all. Throws UsageError for two, and for an entry of a view
// that is none of `views`.
CameraChoice cameraOfView(const std::vector<std::string>& cameras, const std::string& view,
                          const std::vector<std::string>& views);
CameraChoice cameraChoice(const std::string& text);  // "", a name, eye=...;look=... or fit[:A,E]; throws UsageError
SurroundingsChoice surroundingsChoice(const std::string& text);  // "", R,G,B or a file; throws UsageError
// The views of a file that has several. Throws MeaningError for one with fewer.
std::vector<std::string> viewsOf(const std::string& path);

}  // namespace pellucid::cli
