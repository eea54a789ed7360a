// What `study` leaves in its folder.
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "composite/pipeline/study_run.h"

namespace pellucid::cli {

nlohmann::json jsonOf(const std::vector<StudyRow>& rows);

void makeFolder(const std::string& folder);  // with those above it; throws ResourceError

// study.txt, .csv, .json, .svg, .png and .html in a folder that is there. Throws ResourceError.
//   opaque  the picture's name, for the page
void writeStudy(const std::string& folder, const std::string& opaque, const StudyOutcome& outcome);

}  // namespace pellucid::cli
