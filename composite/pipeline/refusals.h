// Combinations that mean nothing, in one table: the README's and the program's.
#pragma once
#include <string>
#include <vector>

#include "composite/pipeline/request.h"

namespace pellucid {

struct Refusal {
  const char* flag;
  const char* found;     // what of it cannot be honoured
  const char* with;      // beside what; {} stands for the method that was asked for
  const char* expected;  // what can
  const char* why;
  bool (*applies)(const Request& request);
  bool ofMethod() const;  // whether another method would honour it
};

const std::vector<Refusal>& refusals();

// Whether what paints weighs its layers.
bool weighs(const Request& request);
// Takes from a request what its method does not read: of settings that several requests share.
void dropUnread(Request& request);
// Where it is read: this weight, instead of fitting one.
void setWeight(Request& request, const shading::WeightSettings& weight);

}  // namespace pellucid
