// A fixed hundred and thirty of the random pictures that ./dev campaign pictures draws.
#include <gtest/gtest.h>

#include "tests/pictures/trial.h"
#include "tests/support/program.h"

namespace pellucid::test {
namespace {

void expectRight(const Trial& trial, const Outcome& outcome, const std::string& folder) {
  EXPECT_TRUE(outcome.right()) << trial.kind << " " << trial.seed << ": " << outcome.refusal << outcome.worst << "\n"
                               << slurp(folder + "/command");
}

TEST(Pictures, AHundredAndThirtyAreRight) {
  const std::string folder = freshFolder("pictures");
  const auto kept = std::make_shared<KeptWork>(-1);
  std::vector<Outcome> outcomes;
  for (std::uint64_t i = 100; i < 230; ++i) {
    const Trial trial{sceneKinds()[i % sceneKinds().size()], i};
    outcomes.push_back(runTrial(trial, folder, kept));
    expectRight(trial, outcomes.back(), folder);
  }
  std::printf("%s", tableOf(outcomes).c_str());
}

// Each was wrong once, by what is said of it.
TEST(Pictures, ThoseThatWereWrongAreRight) {
  const std::string folder = freshFolder("pictures-mended");
  const auto kept = std::make_shared<KeptWork>(-1);
  for (const Trial& trial : {
           Trial{"contact", 21221},   // a pane shone through a wall along the plane of the floor before it
           Trial{"shapes", 22263},    // the same beside a corner
           Trial{"contact", 100651},  // surfaces met in the middle of a pixel, which was taken for either
           Trial{"glass", 102509},    // at the border of the picture a pixel took the slope of what it meets
           Trial{"glass", 102869},    // a pixel that shows a third surface lent its colour to an edge of two
           Trial{"glass", 101319},    // a whole pixel was taken apart by colours continued from another face
           Trial{"shapes", 101603},   // the same
           Trial{"contact", 103261},  // past a surface that parallel rays meet behind the eye everything was seen
           Trial{"decals", 103790},   // a decal on a floor that parallel rays see up to the eye's plane
       })
    expectRight(trial, runTrial(trial, folder, kept), folder);
}

}  // namespace
}  // namespace pellucid::test
