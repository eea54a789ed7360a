// The fixed text of the page: style, controls and the script that draws.
#pragma once

namespace pellucid {

extern const char* const kPageHead;
extern const char* const kPageViews;
extern const char* const kPageScript;

}  // namespace pellucid
