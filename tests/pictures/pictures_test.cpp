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
           Trial{"contact", 21221},      // a pane shone through a wall along the plane of the floor before it
           Trial{"shapes", 22263},       // the same beside a corner
           Trial{"contact", 100651},     // surfaces met in the middle of a pixel, which was taken for either
           Trial{"glass", 102509},       // at the border of the picture a pixel took the slope of what it meets
           Trial{"glass", 102869},       // a pixel that shows a third surface lent its colour to an edge of two
           Trial{"glass", 101319},       // a whole pixel was taken apart by colours continued from another face
           Trial{"shapes", 101603},      // the same
           Trial{"contact", 103261},     // past a surface that parallel rays meet behind the eye everything was seen
           Trial{"decals", 103790},      // a decal on a floor that parallel rays see up to the eye's plane
           Trial{"refracting", 160508},  // what is straight behind glass was taken to stand before it
           Trial{"lamps", 160132},       // bent rays showed the mixed colour of an edge
           Trial{"air", 600101},         // beyond a ridge the nearer plane was seen
           Trial{"lamps", 902315},       // a whole pixel was taken apart beside one that a ridge mixes
           Trial{"lamps", 902601},       // a pixel at a surface's edge took the slope of a curve beside it
           Trial{"shapes", 902398},      // the same at the border of the picture
           Trial{"lamps", 911480},       // a round thing at the border of the picture was taken for two surfaces
           Trial{"shadows", 914744},     // past an edge the farther plane lay before what stands before it
           Trial{"shapes", 916308},      // a round thing three pixels wide between two others was taken for several
           Trial{"refracting", 916419},  // the same, between a crease and its limb
           Trial{"refracting", 917875},  // the same, across a corner of the picture
           Trial{"lamps", 923999},       // the same, four pixels wide, over its nearest point
           Trial{"posts", 942606},       // a whole pixel was a mixture of a colour that is nowhere
           Trial{"glass", 952129},       // three surfaces in a line by chance were taken for a slope
           Trial{"shapes", 923822},      // a corner at the border of the picture went on in what is behind it
       })
    expectRight(trial, runTrial(trial, folder, kept), folder);
}

}  // namespace
}  // namespace pellucid::test
