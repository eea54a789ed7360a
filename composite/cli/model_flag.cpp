#include "composite/cli/model_flag.h"

#include <vector>

#include "composite/cli/messages.h"

namespace pellucid::cli {
namespace {

struct ModelRow {
  const char* name;
  const char* paper;
  std::vector<std::pair<const char*, const char*>> flags;
};

// Constants are those of the listings that the papers print: listing 1 of PS16 and PT17 has k1 = .05 m, a k0 that comes
// to .37 m, net coverage in the place of coverage, and refracts onto a plane 2 m behind.
const std::vector<ModelRow>& models() {
  static const std::vector<std::pair<const char*, const char*>> phenomenological{
      {"--method", "phenomenological"}, {"--precision", "published"},       {"--weight", "eq5"},
      {"--normalisation", "published"}, {"--self-modulation", "true"},      {"--refract", "fixed:2"},
      {"--diffusion", "netCoverage"},   {"--diffusion-scale", "0.37:0.05"}, {"--diffusion-kernel", "disc"},
      {"--dispersion", "off"}};
  static const std::vector<ModelRow> rows{
      {"ps16", "McGuire and Mara 2016, listings 1 and 2, with the self-modulation of PT17", phenomenological},
      {"pt17", "McGuire and Mara 2017, listings 1 and 3", phenomenological},
      {"wb13",
       "McGuire and Bavoil 2013, listing 3 with eq. 7",
       {{"--method", "listing3"}, {"--weight", "eq7"}, {"--refract", "off"}, {"--diffusion", "off"}}},
      {"st10",
       "Enderton and others 2010, depth-based and alpha-corrected, eight samples",
       {{"--method", "stochastic:depth"},
        {"--samples", "8"},
        {"--masks", "stratified"},
        {"--correction", "on"},
        {"--refract", "off"},
        {"--diffusion", "off"}}},
  };
  return rows;
}

}  // namespace

void ModelFlag::addTo(CLI::App& verb) {
  std::vector<std::string> names;
  std::string help = "The settings of a paper's own pictures, but for flags that are given: ";
  for (const ModelRow& row : models()) {
    help += (names.empty() ? "" : "; ") + std::string(row.name) + ": " + row.paper;
    names.emplace_back(row.name);
  }
  verb.add_option("--preset-model", model, help)->check(CLI::IsMember(names));
}

void ModelFlag::apply(CLI::App& verb) const {
  for (const ModelRow& row : models()) {
    if (model != row.name) continue;
    std::string taken;
    for (const auto& [flag, value] : row.flags) {
      CLI::Option* option = verb.get_option(flag);
      if (option->count() > 0) continue;
      option->add_result(value);
      option->run_callback();
      taken += fmt::format(" {}{}", flag, std::string(value) == "true" ? "" : std::string(" ") + value);
    }
    note("--preset-model {} ({}):{}", row.name, row.paper, taken);
  }
}

}  // namespace pellucid::cli
