// What composites where no method is asked for: the truth, unless a flag asks something of the sums.
#include "composite/pipeline/default_method.h"

#include <gtest/gtest.h>

#include "composite/pipeline/plan.h"

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

}  // namespace
}  // namespace pellucid
