#include "tests/reference/texels.h"

#include <algorithm>
#include <cmath>

namespace pellucid::reference {
namespace {

int wrapped(long at, int size, Wrap wrap) {
  if (wrap == Wrap::clamp) return static_cast<int>(std::clamp(at, 0L, static_cast<long>(size) - 1));
  const long period = wrap == Wrap::mirror ? 2L * size : size;
  const long within = ((at % period) + period) % period;
  return static_cast<int>(within < size ? within : period - 1 - within);
}

}  // namespace

Vec4 texelAt(const Texels& texels, Vec2 uv) {
  const auto value = [&](long x, long y) {
    const int s = wrapped(x, texels.width, texels.wrapS), t = wrapped(y, texels.height, texels.wrapT);
    return texels.values[static_cast<std::size_t>(t * texels.width + s)];
  };
  const Vec2 at = uv * Vec2(texels.width, texels.height);
  if (texels.nearest) return value(std::lround(std::floor(at.x)), std::lround(std::floor(at.y)));
  const Vec2 corner = glm::floor(at - 0.5), part = at - 0.5 - corner;
  Vec4 sum(0.0);
  for (int j = 0; j < 2; ++j)
    for (int i = 0; i < 2; ++i) {
      const Vec4 one = value(std::lround(corner.x) + i, std::lround(corner.y) + j);
      const double weight = (i ? part.x : 1.0 - part.x) * (j ? part.y : 1.0 - part.y);
      sum += weight * Vec4(Vec3(one) * one.a, one.a);
    }
  return sum.a > 0.0 ? Vec4(Vec3(sum) / sum.a, sum.a) : Vec4(0.0);
}

double lightOf(int stored) {
  const double value = stored / 255.0;
  return value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4);
}

}  // namespace pellucid::reference
