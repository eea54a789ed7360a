// The fixed text of the page: style, controls, the script that shows colours as a display does, and the one that draws.
#pragma once

namespace pellucid {

extern const char* const kPageHead;
extern const char* const kPageViews;
extern const char* const kPageDisplayScript;  // stands before the other
extern const char* const kPageScript;

}  // namespace pellucid
