// A fixed hundred of the random pictures that ./dev campaign pictures draws.
#include <gtest/gtest.h>

#include "tests/pictures/trial.h"
#include "tests/support/program.h"

namespace pellucid::test {
namespace {

TEST(Pictures, AHundredAreRight) {
  const std::string folder = freshFolder("pictures");
  const auto kept = std::make_shared<KeptWork>(-1);
  std::vector<Outcome> outcomes;
  for (std::uint64_t i = 100; i < 200; ++i) {
    const Trial trial{sceneKinds()[i % sceneKinds().size()], i};
    outcomes.push_back(runTrial(trial, folder, kept));
    EXPECT_TRUE(outcomes.back().right()) << trial.kind << " " << trial.seed << ": " << outcomes.back().refusal
                                         << outcomes.back().worst << "\n"
                                         << slurp(folder + "/command");
  }
  std::printf("%s", tableOf(outcomes).c_str());
}

}  // namespace
}  // namespace pellucid::test
