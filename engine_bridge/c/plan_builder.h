// Puts a recipe's plan together, stage by stage: see recipe_plan.h.
#pragma once
#include "engine_bridge/c/plan_resolve.h"

namespace pellucid::c {

class PlanBuilder : public ResolvePlan {
 public:
  using ResolvePlan::ResolvePlan;

  // Each adds the passes that the permutation has of it, in this order; those of ResolvePlan come after.
  void addPlanarDepth();
  void addStages();  // solids, front, layers, rims
  void addRimsApplied();
  void addLowResolution();

 private:
  void addStage(pld_stage stage, const char* name, const Planes& planes);
  void addFold(pld_stage stage, const char* name, const Planes& planes);
  void addSolidMarks();
  void addListedMarks();
  void readSeam(PlannedPass& pass) const;
};

// Of a permutation that is not refused.
RecipePlan recipePlan(const Permutation& permutation, const PlanShape& shape);

}  // namespace pellucid::c
