// What is peculiar to the targets of the `published` tier, PT17 table 2: numbers that do not fit are counted, and
// pixels are decoded by steps.
#pragma once
#include "engine_bridge/gl/plane_targets.h"
#include "gbuffer/published.h"

namespace pellucid::gl {

class PublishedTargets {
 public:
  PublishedTargets(int width, int height);

  int width() const { return targets_.width(); }
  int height() const { return targets_.height(); }

  // As PlaneTargets::begin(), for draws with Output::published.
  void begin(const std::vector<PlaneSpec>& planes);
  // Decoded into the planes, the targets' top left pixel at (x, y); what did not fit is counted.
  void read(OitPlanes& planes, int x, int y, PublishedClamps& clamps) const;

 private:
  PlaneTargets targets_;
  bool scatters_ = false;
  Buffer clamped_;
};

}  // namespace pellucid::gl
