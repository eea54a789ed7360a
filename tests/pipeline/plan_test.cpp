// Plans are values: what was decided can be held against a table, without a file or a device.
#include <gtest/gtest.h>

#include "composite/pipeline/plan.h"
#include "gbuffer/errors.h"
#include "tests/pipeline/shot_files.h"

namespace pellucid {
namespace {

using test::paintOf;

struct Row {
  const char* method;
  Tier tier;
  bool deepPicture, deepFiles, hasScene;
  Route route;
};

ShotFacts factsOf(const Row& row) {
  ShotFacts facts;
  facts.width = 8;
  facts.height = 6;
  facts.hasScene = row.hasScene;
  facts.deepPicture = row.deepPicture;
  facts.deepFiles = row.deepFiles ? 1 : 0;
  return facts;
}

TEST(Plan, RoutesFollowTheTable) {
  const Row rows[] = {
      {"phenomenological", Tier::float32, false, false, true, Route::drawnSums},
      {"phenomenological", Tier::published, false, false, true, Route::drawnSums},
      {"phenomenological", Tier::exact, false, false, true, Route::foldedSums},
      {"phenomenological", Tier::float32, false, true, true, Route::foldedSums},
      {"phenomenological", Tier::float32, false, true, false, Route::foldedSums},
      {"phenomenological", Tier::float32, true, false, true, Route::lists},
      {"weighted", Tier::float32, false, false, true, Route::drawnSums},
      {"weighted", Tier::exact, false, false, true, Route::foldedSums},
      {"blended", Tier::float32, false, false, true, Route::drawnSums},
      {"over", Tier::float32, false, false, true, Route::lists},
      {"sum", Tier::float32, false, false, true, Route::lists},
      {"mlab:4", Tier::exact, true, true, true, Route::lists},
      {"stochastic", Tier::float32, true, false, true, Route::lists},
  };
  for (const Row& row : rows) {
    Request request;
    request.method = row.method;
    request.paint = paintOf(row.method);
    request.tier = row.tier;
    const Plan plan = planFor(request, factsOf(row));
    EXPECT_EQ(plan.route, row.route) << row.method << ", " << nameOf(plan.route);
    EXPECT_EQ(plan.heldOut, row.deepPicture);
  }
}

TEST(Plan, TheSameRequestAndFactsGiveTheSamePlan) {
  Request request;
  request.passes = 8;
  const ShotFacts facts = factsOf({"", Tier::float32, false, false, true, Route::lists});
  EXPECT_EQ(describe(planFor(request, facts), facts), describe(planFor(request, facts), facts));
}

TEST(Plan, TheRangeComesFromTheRequestThenTheCameraThenTheDefault) {
  ShotFacts facts;
  Request request;
  EXPECT_FLOAT_EQ(planFor(request, facts).pass.weight.rangeNear, 0.1f);
  EXPECT_FLOAT_EQ(planFor(request, facts).pass.weight.rangeFar, 1000.0f);
  facts.rangeNear = 2.0;
  facts.rangeFar = 50.0;
  EXPECT_FLOAT_EQ(planFor(request, facts).pass.weight.rangeFar, 50.0f);
  request.sums.weightRange = {1.0, 20.0};
  EXPECT_FLOAT_EQ(planFor(request, facts).pass.weight.rangeNear, 1.0f);
}

TEST(Plan, MarksDecideTheLowResolution) {
  ShotFacts facts;
  Request request;
  EXPECT_EQ(planFor(request, facts).lowResolution, 1);
  facts.marksLowResolution = true;
  EXPECT_EQ(planFor(request, facts).lowResolution, LowResolutionRequest::kDefault);
  request.lowResolution.factor = 1;
  EXPECT_EQ(planFor(request, facts).lowResolution, 1);
  facts.marksLowResolution = false;
  request.lowResolution.factor = 2;
  EXPECT_THROW(planFor(request, facts), UsageError);
}

TEST(Plan, WhatTheDeviceCannotSampleIsSaid) {
  Request request = test::requestOf("", "");
  PaintSamples samples;
  samples.onDevice = true;
  request.paint = samples;
  ShotFacts facts;
  EXPECT_EQ(planFor(request, facts).route, Route::samplesOnDevice);
  facts.deepFiles = 1;
  const Plan plan = planFor(request, facts);
  EXPECT_EQ(plan.route, Route::lists);
  ASSERT_EQ(plan.notes.size(), 1u);
  EXPECT_NE(plan.notes[0].find("deep samples are no triangles"), std::string::npos);
}

}  // namespace
}  // namespace pellucid
