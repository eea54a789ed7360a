// campaign_pictures FOLDER [COUNT [FIRST [KIND...]]]: COUNT random pictures, held against the reference. Prints every
// picture that differs, and a table; what differs is kept in FOLDER. Ends with 1 when there is any.
// campaign_pictures rays KIND SEED X Y: what the passes meet in a pixel.
#include <fmt/format.h>

#include <charconv>
#include <filesystem>
#include <stdexcept>

#include "tests/pictures/trial.h"

namespace pellucid::test {
namespace {

std::uint64_t numberOf(const std::string& text) {
  std::uint64_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size())
    throw std::invalid_argument("found '" + text + "', expected a whole number");
  return number;
}

int run(const std::vector<std::string>& arguments) {
  if (arguments.empty()) throw std::invalid_argument("found no folder for what differs");
  if (arguments[0] == "rays" && arguments.size() == 5) {
    const Trial trial{arguments[1], numberOf(arguments[2])};
    fmt::print("{}", raysOf(trial, static_cast<int>(numberOf(arguments[3])), static_cast<int>(numberOf(arguments[4]))));
    return 0;
  }
  const std::uint64_t count = arguments.size() > 1 ? numberOf(arguments[1]) : 1000;
  const std::uint64_t first = arguments.size() > 2 ? numberOf(arguments[2]) : 0;
  const std::vector<std::string> kinds =
      arguments.size() > 3 ? std::vector<std::string>(arguments.begin() + 3, arguments.end()) : sceneKinds();
  const auto kept = std::make_shared<KeptWork>(-1);
  std::vector<Outcome> outcomes;
  bool right = true;
  for (std::uint64_t i = first; i < first + count; ++i) {
    const Trial trial{kinds[i % kinds.size()], i};
    const std::filesystem::path folder = arguments[0] + "/" + fmt::format("{}-{}", trial.kind, trial.seed);
    std::filesystem::create_directories(folder);
    outcomes.push_back(runTrial(trial, folder.string(), kept));
    const Outcome& outcome = outcomes.back();
    if (outcome.right()) {
      std::filesystem::remove_all(folder);
      continue;
    }
    right = false;
    std::size_t beyond = 0;
    for (const Tally& tally : outcome.tallies) beyond += tally.beyond;
    fmt::print("{} {}: {}{}{}\n", trial.kind, trial.seed, outcome.refusal,
               beyond > 0 ? fmt::format("{} pixels beyond, ", beyond) : "", outcome.worst);
    std::fflush(stdout);
  }
  fmt::print("{}", tableOf(outcomes));
  return right ? 0 : 1;
}

}  // namespace
}  // namespace pellucid::test

int main(int count, char** arguments) {
  try {
    return pellucid::test::run({arguments + 1, arguments + count});
  } catch (const std::exception& error) {
    fmt::print(stderr, "campaign_pictures: {}\n", error.what());
    return 2;
  }
}
