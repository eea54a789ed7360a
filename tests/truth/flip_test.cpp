// FLIP against the program of its authors, v1.7: mean and four pixels of five pairs of pictures.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "composite/study/flip.h"
#include "tests/truth/flip_pictures.h"

namespace pellucid {
namespace {

using namespace test;

struct Known {
  double mean, pixels[4];  // at (0, 0), (48, 20), (41, 32), (90, 50)
};
const Known kKnown[kFlipPairs] = {{0.2148597, {0.2028096, 0.1759962, 0.1623124, 0.2929773}},
                                  {0.2640629, {0.0015143, 0.4248624, 0.4328176, 0.4263492}},
                                  {0.3952173, {0.8626595, 0.3246686, 0.3232010, 0.4820384}},
                                  {0.0442227, {0.0000000, 0.3922888, 0.0000000, 0.6987093}},
                                  {0.5810633, {0.0000000, 0.9712374, 0.9758322, 0.9681342}}};

Image<glm::vec4> pictureOf(int pair, bool second) {
  Image<glm::vec4> picture(kFlipWidth, kFlipHeight);
  for (int y = 0; y < kFlipHeight; ++y)
    for (int x = 0; x < kFlipWidth; ++x) {
      for (int c = 0; c < 3; ++c) picture.at(x, y)[c] = flipValue(pair, second, x, y, c);
      picture.at(x, y).a = 1.0f;
    }
  return picture;
}

TEST(Flip, AgreesWithItsAuthorsProgram) {
  const int places[4][2] = {{0, 0}, {48, 20}, {41, 32}, {90, 50}};
  double worstMean = 0, worstPixel = 0;
  for (int pair = 0; pair < kFlipPairs; ++pair) {
    const Image<float> map = FlipReference(pictureOf(pair, false)).map(pictureOf(pair, true));
    worstMean = std::max(worstMean, std::abs(meanOf(map) - kKnown[pair].mean));
    for (int k = 0; k < 4; ++k)
      worstPixel = std::max(worstPixel,
                            std::abs(static_cast<double>(map.at(places[k][0], places[k][1])) - kKnown[pair].pixels[k]));
  }
  std::printf("[ figure ] FLIP of five pairs against the authors' program: mean %.2g, pixels %.2g\n", worstMean,
              worstPixel);
  // It works in float: a feature difference of 1e-9 comes out as 3e-5.
  EXPECT_LT(worstMean, 5e-5);
  EXPECT_LT(worstPixel, 1e-4);
}

TEST(Flip, SameIsZeroAndWhatIsNotFiniteIsFinite) {
  Image<glm::vec4> picture = pictureOf(2, false);
  EXPECT_EQ(meanOf(FlipReference(picture).map(picture)), 0.0);
  picture.at(5, 5).r = std::numeric_limits<float>::quiet_NaN();
  picture.at(6, 5).g = std::numeric_limits<float>::infinity();
  const double mean = meanOf(FlipReference(picture).map(pictureOf(2, false)));
  EXPECT_TRUE(std::isfinite(mean));
  EXPECT_LT(mean, .1);
  EXPECT_EQ(meanOf(FlipReference(Image<glm::vec4>()).map(Image<glm::vec4>())), 0.0);
}

}  // namespace
}  // namespace pellucid
