// What `study` leaves in its folder.
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "composite/colour/display.h"
#include "composite/pipeline/study_run.h"

namespace pellucid::cli {

//   space  of the pictures, in which errors are measured
nlohmann::json jsonOf(const std::vector<StudyRow>& rows, const ColourSpace& space);

void makeFolder(const std::string& folder);  // with those above it; throws ResourceError

// study.txt, .csv, .json, .svg, .png and .html in a folder that is there. Throws ResourceError.
//   opaque    the picture: its name, and its space
//   shown     how the page shows colours
//   exposure  of the page at first, stops
void writeStudy(const std::string& folder, const OpaqueFile& opaque, const StudyOutcome& outcome,
                const DisplayShader& shown, double exposure);

}  // namespace pellucid::cli
