// Flags of ambient occlusion at cut-out leaves, for the verbs that shade them.
#pragma once
#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "composite/pipeline/resolve_planes.h"

namespace pellucid::cli {

struct FoliageFlags {
  std::string occlusion = "inferred", inference = "relative", source = "auto";
  double direct = 0.0, radius = 0.0;
  CLI::Option* details[4] = {};  // form, direct share, radius, source: empty in the request unless they are given
  //   keepsApart  the verb can also leave the rims to `resolve`
  void addTo(CLI::App& verb, bool keepsApart = false);
  void into(Request& request) const;
};

// The same of `resolve`, for planes that carry the light of their rims apart.
struct RimFlags {
  std::string occlusion = "inferred", inference = "relative", source = "auto";
  double radius = 0.0;
  std::vector<CLI::Option*> given;
  void addTo(CLI::App& verb);
  RimRequest request() const;
};

}  // namespace pellucid::cli
