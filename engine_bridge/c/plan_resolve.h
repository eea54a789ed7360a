// The passes of pld_resolve(): the spread pyramid, the picture and what else is shown.
#pragma once
#include "engine_bridge/c/plan_parts.h"

namespace pellucid::c {

class ResolvePlan : public PlanParts {
 public:
  using PlanParts::PlanParts;

  // Each adds the passes that the permutation has of it, in this order.
  void addSpread();
  void addPicture();
  void addDebugViews();

 private:
  PlannedPass& addShown(const char* name, const char* file, int firstView, int lastView);
  void readResolved(PlannedPass& pass, bool colour, bool nearest) const;
  void readPyramid(PlannedPass& pass, int32_t layer) const;
};

}  // namespace pellucid::c
