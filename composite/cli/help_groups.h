// Where each flag stands in --help, and what each verb's help ends with. A table, so that a flag is added to a verb
// without a word about its place, and a test holds that it has one.
#pragma once
#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace pellucid::cli {

namespace headings {
inline constexpr const char *kCommon = "Most used", *kInput = "Input", *kPicture = "Picture", *kMethod = "Method",
                            *kScattering = "Scattering", *kLight = "Light and shadow", *kAir = "Air",
                            *kTime = "Time and lens", *kQuality = "Quality", *kOutput = "Output",
                            *kThresholds = "Thresholds", *kRunning = "Running";
}  // namespace headings

// The headings, in the order of --help. Flags that most people need stand under the first, whatever they do.
const std::vector<std::string>& helpGroups();

struct HelpRow {
  const char* flag;   // its long name
  const char* group;  // one of helpGroups()
  const char* value;  // the word for its value: "FILE", "X,Y,Z"; "" where it takes none, or one of a few
};
const std::vector<HelpRow>& helpRows();
const HelpRow* helpRow(const std::string& flag);  // null for a flag without a row

// One command line of the verb, as a user would type it; "" for an unknown verb.
std::string exampleOf(const std::string& verb);

// Gives every flag of every verb its group, and the program its form of --help.
void setUpHelp(CLI::App& app);

}  // namespace pellucid::cli
