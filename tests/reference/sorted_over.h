// The unshared voice: sorted compositing in double precision, written from PS16 eq. 1 and MODEL section 1 alone.
// Includes nothing of shaders/ or composite/.
#pragma once
#include <array>
#include <vector>

namespace pellucid::reference {

using Rgb = std::array<double, 3>;

struct Layer {
  double coverage = 0;  // alpha
  Rgb transmission{};   // t
  Rgb reflected{};      // L_r, as if coverage were 1
  Rgb additive{};       // E, premultiplied
  double z = 0;
};

// L <- alpha (L_r + t L) + (1 - alpha) L, plus E at its depth, back to front. Layers need distinct depths.
Rgb sortedOver(std::vector<Layer> layers, Rgb background);

// beta = product of [1 - alpha (1 - t)]
Rgb modulation(const std::vector<Layer>& layers);

}  // namespace pellucid::reference
