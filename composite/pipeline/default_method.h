// The method where none is asked for: the truth, unless something is asked that the sums alone read.
#pragma once
#include <string>
#include <vector>

namespace pellucid {

// A flag as it was given.
struct GivenFlag {
  std::string flag, value;  // "--weight", "eq7"; the value of a switch is its own
};

// A flag that means something to the phenomenological sums alone, and so asks for them.
struct SumsFlag {
  const char* flag;
  const char* neutral;  // the value that asks nothing; null: every value asks
  const char* why;
  bool approximates;  // the picture is no longer the truth, which is said
};
const std::vector<SumsFlag>& sumsFlags();

struct MethodDecision {
  std::string method;
  std::string reason;  // for --explain
  std::string note;    // what must be said aloud, or ""
};

// A pure function of the flags, in the order of the table above.
MethodDecision decideMethod(const std::vector<GivenFlag>& given);

}  // namespace pellucid
