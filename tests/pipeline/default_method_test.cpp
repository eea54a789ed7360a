// What composites where no method is asked for: the truth, unless a flag asks something of the sums.
#include "composite/pipeline/default_method.h"

#include <gtest/gtest.h>

#include "composite/pipeline/default_weight.h"
#include "composite/pipeline/plan.h"
#include "tests/pipeline/shot_files.h"

namespace pellucid {
namespace {

TEST(DefaultMethod, IsTheTruth) {
  EXPECT_EQ(Request().method, "over");
  EXPECT_TRUE(paintsBy<PaintSorted>(Request()));
  for (const std::vector<GivenFlag>& given : {std::vector<GivenFlag>{}, {{"--aa", "4"}, {"--fog", "density=1"}}}) {
    const MethodDecision decision = decideMethod(given);
    EXPECT_EQ(decision.method, "over");
    EXPECT_EQ(decision.note, "");
  }
}

TEST(DefaultMethod, FlagsOfTheSumsAskForThem) {
  for (const SumsFlag& row : sumsFlags()) {
    const MethodDecision decision = decideMethod({{"--aa", "4"}, {row.flag, "any"}});
    EXPECT_EQ(decision.method, "phenomenological") << row.flag;
    EXPECT_NE(decision.reason.find(row.flag), std::string::npos) << decision.reason;
    // A tolerance keeps what it promises of the truth: there is nothing to say aloud.
    EXPECT_EQ(decision.note.empty(), std::string(row.flag) == "--tolerance") << decision.note;
    if (row.neutral) {
      EXPECT_EQ(decideMethod({{row.flag, row.neutral}}).method, "over") << row.flag;
    }
  }
}

TEST(DefaultMethod, AToleranceComesBeforeWhatElseIsAskedOfTheSums) {
  const MethodDecision decision = decideMethod({{"--weight", "uniform"}, {"--tolerance", ".1"}});
  EXPECT_EQ(decision.method, "phenomenological");
  EXPECT_EQ(decision.note, "");
}

TEST(DefaultMethod, ThePlanTellsIt) {
  ShotFacts facts;
  Request request;
  request.decided = decideMethod({});
  EXPECT_EQ(describe(planFor(request, facts), facts)[0], "method      over (the default: exact)");
  EXPECT_TRUE(planFor(request, facts).notes.empty());
  request.decided = decideMethod({{"--precision", "exact"}});
  request.method = request.decided->method;
  request.paint = PaintSums{};
  const Plan plan = planFor(request, facts);
  EXPECT_EQ(describe(plan, facts)[0],
            "method      phenomenological (--precision is given: it says what the sums are kept in)");
  ASSERT_EQ(plan.notes.size(), 1u);
  EXPECT_EQ(plan.notes[0], request.decided->note);
}

// Which requests fit their weight: where it is asked for, and the sums of a whole shot about whose weight nothing is
// said.
TEST(DefaultWeight, IsFittedWhereNothingIsStated) {
  struct Row {
    const char *name, *method;
    void (*ask)(Request& request);
    bool fits;
  };
  const Row rows[] = {
      {"plain", "phenomenological", [](Request&) {}, true},
      {"plain", "weighted", [](Request&) {}, true},
      {"plain", "blended", [](Request&) {}, false},
      {"plain", "front+tail", [](Request&) {}, false},
      {"plain", "over", [](Request&) {}, false},
      {"auto", "front+tail", [](Request& r) { r.sums.fitWeight = true; }, true},
      {"weight", "phenomenological", [](Request& r) { r.sums.weight = PassSettings().weight; }, false},
      {"range", "phenomenological",
       [](Request& r) {
         r.sums.weightRange = {1.0, 20.0};
       },
       false},
      {"file", "phenomenological", [](Request& r) { r.sums.weightFrom = "first.exr"; }, false},
      {"exact", "phenomenological", [](Request& r) { r.tier = Tier::exact; }, true},
      {"published", "phenomenological", [](Request& r) { r.tier = Tier::published; }, false},
      {"normalisation", "phenomenological", [](Request& r) { r.sums.normalisation = 0; }, true},
      {"held out", "phenomenological", [](Request& r) { r.heldOutBy = {"near.exr"}; }, false},
      {"tolerance", "phenomenological", [](Request& r) { r.paint = PaintWithin{0.1}; }, false},
      {"systems", "phenomenological", [](Request& r) { r.paint = PaintSystems{}; }, false},
  };
  for (const Row& row : rows) {
    Request request;
    request.method = row.method;
    request.paint = test::paintOf(row.method);
    row.ask(request);
    EXPECT_EQ(fitsWeight(request), row.fits) << row.method << ", " << row.name;
    const ShotFacts facts;
    const Plan plan = planFor(request, facts);
    EXPECT_EQ(plan.fitsWeight, row.fits) << row.method << ", " << row.name;
    EXPECT_EQ(plan.weightReason.empty(), !row.fits || request.sums.fitWeight) << row.method << ", " << row.name;
  }
}

}  // namespace
}  // namespace pellucid
