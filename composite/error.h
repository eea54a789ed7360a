// How far a picture lies from the truth.
#pragma once
#include <cstddef>
#include <glm/glm.hpp>
#include <string>

#include "gbuffer/image.h"

namespace pellucid {

// Over all pixels and R, G, B; scene-linear. Pixels where either picture is not finite are counted apart.
struct ErrorStatistics {
  double mean = 0, rmse = 0, p99 = 0, maximum = 0;  // of |picture - truth|; p99 over pixels' largest channel
  int worstX = 0, worstY = 0;                       // pixel of the maximum, data window coordinates from 0
  std::size_t pixels = 0, nonFinite = 0;
};

ErrorStatistics measureError(const Image<glm::vec4>& picture, const Image<glm::vec4>& truth);
std::string errorLine(const ErrorStatistics& error);  // "mean 0.0012  rmse 0.0043  p99 0.021  max 0.16 at (411, 220)"

}  // namespace pellucid
