// What can be refused before any file is opened.
#pragma once
#include "composite/pipeline/request.h"

namespace pellucid {

// Throws UsageError, one sentence that names the flag, what was found beside it and why they do not go together.
void validate(const Request& request);

}  // namespace pellucid
