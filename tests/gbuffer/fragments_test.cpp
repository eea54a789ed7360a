// Fragment lists are put together, ordered and thinned out with all of their columns.
#include "gbuffer/fragments.h"

#include <gtest/gtest.h>

namespace pellucid {
namespace {

Fragment fragmentAt(float z) {
  Fragment fragment{};
  fragment.z = z;
  return fragment;
}

// Rows of every column that say which fragment they belong to.
FragmentLists numbered(const std::vector<float>& depths) {
  FragmentLists lists;
  for (const float z : depths) lists.append(fragmentAt(z));
  for (FragmentColumn* column : lists.columns())
    for (const float z : depths) column->emplace_back(z);
  return lists;
}

void expectNumbered(const FragmentLists& lists, const std::vector<float>& depths, const std::vector<float>& rows) {
  ASSERT_EQ(lists.fragments.size(), depths.size());
  for (std::size_t i = 0; i < depths.size(); ++i) EXPECT_EQ(lists.fragments[i].z, depths[i]) << i;
  for (const FragmentColumn* column : lists.columns()) {
    ASSERT_EQ(column->size(), rows.size());
    for (std::size_t i = 0; i < rows.size(); ++i) EXPECT_EQ((*column)[i], glm::vec4(rows[i])) << i;
  }
}

TEST(FragmentColumns, AreThereForEveryFragmentOnceOneHasThem) {
  FragmentLists lists;
  lists.append(fragmentAt(1));
  EXPECT_FALSE(lists.hasColumns());
  lists.append(numbered({2, 3, 4}), 1, 3);
  lists.append(fragmentAt(5));
  FragmentLists plain;
  plain.append(fragmentAt(6));
  lists.append(plain, 0, 1);
  expectNumbered(lists, {1, 3, 4, 5, 6}, {0, 3, 4, 0, 0});
  lists.clearColumns();
  EXPECT_FALSE(lists.hasColumns());
}

TEST(FragmentColumns, OfOtherListsAreZeroWhereNoFragmentCameFromThem) {
  FragmentLists lists;
  lists.append(fragmentAt(1));
  lists.append(numbered({2}), 0, 0);
  EXPECT_FALSE(lists.hasColumns());
  lists.addColumnsOf(numbered({2}));
  expectNumbered(lists, {1}, {0});
  FragmentLists plain;
  plain.append(fragmentAt(1));
  lists.addColumnsOf(plain);
  expectNumbered(lists, {1}, {0});
}

TEST(FragmentColumns, FollowWhatIsKeptAndReordered) {
  FragmentLists lists = numbered({7, 1, 9, 2, 8});
  lists.keepFrom(1, [](const Fragment& fragment) { return fragment.z < 9.0f; });
  expectNumbered(lists, {7, 1, 2, 8}, {7, 1, 2, 8});
  lists.reorder(1, {2, 0, 1});
  expectNumbered(lists, {7, 8, 1, 2}, {7, 8, 1, 2});
  EXPECT_NE(lists.compareColumns(0, 1), 0);
  EXPECT_EQ(lists.compareColumns(1, 1), 0);
  EXPECT_EQ(lists.compareColumns(0, 1) < 0, lists.compareColumns(1, 0) > 0);
}

TEST(FragmentColumns, AreThoseThatTheLayersNeed) {
  LayerModel layers;
  FragmentLists lists = numbered({1, 2});
  lists.resize(3, layers);
  EXPECT_FALSE(lists.hasColumns());
  layers.refracts = layers.disperses = true;
  lists.resize(4, layers);
  EXPECT_TRUE(lists.hasColumns());
  for (const FragmentColumn* column : lists.columns()) EXPECT_EQ(column->size(), 4u);
}

}  // namespace
}  // namespace pellucid
