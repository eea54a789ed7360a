// What transparency does to a picture before it meets one: picture = light + transmission * background. Where layers
// refract or diffuse, picture = light + direct * background + applied.
#pragma once
#include <cstdint>
#include <glm/glm.hpp>

#include "gbuffer/image.h"

namespace pellucid {

// Planes of a data window or of a part of it, beyond which nothing is. Where touched is 0 nothing transparent lies and
// the other planes mean nothing.
struct Veil {
  glm::ivec2 place{0};            // of the first pixel, in the data window
  Image<glm::vec3> light;         // premultiplied radiance of the layers and of the solid behind them, >= 0
  Image<glm::vec3> transmission;  // of the background, [0,1] per channel; 0 behind a solid
  Image<float> frontZ;            // nearest layer or solid, planar metres, +inf for none
  Image<std::uint8_t> touched;
  // Empty when nothing refracts or diffuses.
  Image<glm::vec3> direct;   // part of the transmission that shows the pixel's own background
  Image<glm::vec4> applied;  // the other part times the background it shows; a: its mean times (1 - that alpha)

  Veil() = default;
  Veil(int width, int height);
  // Of a part of the data window, both in display coordinates.
  Veil(const Window& part, const Window& data);
  bool scatters() const { return !applied.empty(); }
  void addScatter();  // direct = transmission, applied = 0, unless they are there
};

// Rows y0 to y1 of a veil, y1 not among them.
Veil rowsOf(const Veil& veil, int y0, int y1);

// The same in a veil of all of the data window's size.
Veil widened(Veil veil, const Window& data);

// The mean of equally weighted samples, added in the order they come: N jittered passes become one antialiased veil.
class VeilMean {
 public:
  void add(Veil sample);
  // The same piece by piece: rows of one more sample follow, as rowsOf() cuts them, each once and from the top.
  void begin(const Veil& sample);
  void addRows(const Veil& rows);
  Veil finish();  // at least one sample must have been added, and none is kept

 private:
  Veil sum_;
  int count_ = 0;
};

}  // namespace pellucid
