// The unshared voice of fog: a front-to-back march in double precision, in world space, written from the radiative
// transfer of emission and single scattering alone. Includes nothing of shaders/ or composite/.
#pragma once
#include <array>
#include <functional>
#include <vector>

namespace pellucid::reference {

using Vec = std::array<double, 3>;

struct Air {
  std::function<double(const Vec&)> extinction;  // 1/m
  Vec albedo{1, 1, 1};
  double g = 0;
  Vec ambient{};  // radiance from everywhere
  // Radiance that a metre adds; null: none.
  std::function<Vec(const Vec&)> emission = nullptr;
};

struct Lamp {
  bool sun = false;
  Vec place{};      // of a lamp, or the unit direction towards a sun
  Vec intensity{};  // W/sr of a lamp, W/m^2 of a sun
  std::function<double(const Vec&)> visible = [](const Vec&) { return 1.0; };
};

struct Marched {
  Vec radiance{};
  double transmittance = 1;
};

// From `eye` along the unit `way`. Midpoint rule, `steps` even steps; light is not dimmed on its way to the ray but by
// Lamp::visible.
Marched orderedMarch(const Air& air, const std::vector<Lamp>& lamps, const Vec& eye, const Vec& way, double length,
                     int steps);

// Of light that turns by the angle with this cosine.
double phase(double cosine, double g);

}  // namespace pellucid::reference
