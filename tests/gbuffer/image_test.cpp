// An image with its own pixels, and one that shows those of another.
#include "gbuffer/image.h"

#include <gtest/gtest.h>

#include <memory>
#include <utility>
#include <vector>

namespace pellucid {
namespace {

std::shared_ptr<std::vector<float>> sixPixels() {
  return std::make_shared<std::vector<float>>(std::vector<float>{0, 1, 2, 3, 4, 5});
}

Image<float> shownOf(const std::shared_ptr<std::vector<float>>& pixels) {
  return Image<float>::borrowed(3, 2, pixels->data(), pixels);
}

TEST(Image, BorrowedPixelsStayWhereTheyAreAndAlive) {
  std::shared_ptr<std::vector<float>> pixels = sixPixels();
  const float* first = pixels->data();
  const std::weak_ptr<std::vector<float>> alive = pixels;
  Image<float> image = shownOf(pixels);
  pixels.reset();
  ASSERT_FALSE(alive.expired());
  EXPECT_EQ(image.data(), first);
  EXPECT_EQ(image.size(), 6u);
  EXPECT_EQ(image.at(1, 1), 4.0f);
  EXPECT_EQ(image.row(1), first + 3);
  Image<float> moved = std::move(image);
  EXPECT_TRUE(image.empty());
  EXPECT_EQ(moved.data(), first);
  moved = Image<float>();
  EXPECT_TRUE(alive.expired());
}

TEST(Image, ACopyHasItsOwnPixels) {
  const std::shared_ptr<std::vector<float>> pixels = sixPixels();
  const Image<float> image = shownOf(pixels);
  Image<float> copy = image, assigned(3, 2, 9.0f);
  const float* held = assigned.data();
  assigned = image;
  EXPECT_EQ(assigned.data(), held) << "memory of the same size is used again";
  copy.at(0, 0) = assigned.at(2, 1) = -1.0f;
  EXPECT_EQ(*pixels, (std::vector<float>{0, 1, 2, 3, 4, 5}));
  EXPECT_EQ(copy.at(2, 1), 5.0f);
  EXPECT_EQ(pixels.use_count(), 2) << "copies do not hold the owner";
}

TEST(Image, AssignedOverItIsNoLongerBorrowed) {
  const std::shared_ptr<std::vector<float>> pixels = sixPixels();
  Image<float> image = shownOf(pixels);
  image = Image<float>(1, 1, 7.0f);
  image.at(0, 0) = 8.0f;
  Image<float> other = shownOf(pixels);
  const Image<float> own(2, 1, 6.0f);
  other = own;
  other.at(1, 0) = 8.0f;
  EXPECT_EQ(pixels->front(), 0.0f);
  EXPECT_EQ(own.at(1, 0), 6.0f);
  EXPECT_EQ(other.width(), 2);
  EXPECT_EQ(pixels.use_count(), 1);
}

TEST(Image, ShownIsTheSamePixels) {
  const Image<float> own(4, 4, 1.0f);
  const Image<float> shown = own.shown(nullptr);
  EXPECT_EQ(shown.data(), own.data());
  EXPECT_EQ(shown.width(), 4);
  EXPECT_EQ(shown.height(), 4);
  EXPECT_TRUE(Image<float>().shown(nullptr).empty());
}

TEST(Image, MovedAndCopiedOntoItself) {
  Image<float> image(2, 2, 3.0f);
  Image<float>& same = image;
  image = same;
  EXPECT_EQ(image.at(1, 1), 3.0f);
  image = std::move(same);
  EXPECT_EQ(image.size(), 4u);
  EXPECT_EQ(image.at(1, 1), 3.0f);
}

}  // namespace
}  // namespace pellucid
