// Everything of a GL context that can be asked, to see what a call leaves changed.
#pragma once
#include <map>
#include <string>
#include <vector>

namespace pellucid::test {

// Name of a piece of state to its values.
using GlState = std::map<std::string, std::vector<double>>;

GlState glState();
// "BLEND[3]: 1 -> 0" for each that differs.
std::vector<std::string> changes(const GlState& before, const GlState& after);

// Sets all of it to values that are unlike the defaults, with objects of its own bound wherever one can be.
void setUnlikelyState();

}  // namespace pellucid::test
