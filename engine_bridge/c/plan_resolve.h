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
  void addMasks();    // PLD_FEATURE_OUTPUTS
  void addOutputs();  // PLD_FEATURE_DEPTHS, _MOTION, _IDENTITY
  void addDebugViews();

 private:
  void addDepths();
  void addMarks();
  // Of what looks at a pixel's layers alone: what its texts, which unpack the sums, look up of them.
  PlannedPass& addLook(const char* name, const char* file, int view);
  PlannedPass& addListed(const char* name, const char* component, int view);
  void readSums(PlannedPass& pass) const;
  PlannedPass& addShown(const char* name, const char* file, int firstView, int lastView);
  void readResolved(PlannedPass& pass, bool colour, bool nearest) const;
  void readPyramid(PlannedPass& pass, int32_t layer) const;
};

}  // namespace pellucid::c
