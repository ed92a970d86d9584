#include <cstdint>
#include <utility>

#include <gtest/gtest.h>

#include "lcmtypes/base/growing_array.hpp"

namespace kintsugi {
namespace {

TEST(GrowingArray, IsEmptyAtFirst) {
  const GrowingArray<int> array;
  EXPECT_TRUE(array.empty());
  EXPECT_EQ(array.begin(), array.end());
  EXPECT_EQ(array.bytes(), 0U);
}

TEST(GrowingArray, NeverMovesItsElements) {
  GrowingArray<std::uint64_t> array;
  array.push_back(7);
  const std::uint64_t* const first = &array[0];
  for (std::uint64_t i = 1; i < 1'000'000; ++i) array.push_back(i);
  EXPECT_EQ(&array[0], first);
  EXPECT_EQ(*first, 7U);
  for (std::uint64_t i = 1; i < array.size(); ++i) ASSERT_EQ(array[i], i);
}

TEST(GrowingArray, GivesNewElementsTheirValue) {
  GrowingArray<int> array(3);
  EXPECT_EQ(array[2], 0);
  array.resize(1'000'000, -1);
  EXPECT_EQ(array[2], 0);
  EXPECT_EQ(array[3], -1);
  EXPECT_EQ(array.back(), -1);
}

TEST(GrowingArray, TakesMemoryAsItGrows) {
  GrowingArray<std::uint32_t> array(1);
  EXPECT_LE(array.bytes(), std::size_t{1} << 21);
  array.resize(std::size_t{3} << 20);
  EXPECT_EQ(array.bytes(), std::size_t{3} << 22);
}

TEST(GrowingArray, CanBeMoved) {
  GrowingArray<int> array(2);
  array[1] = 5;
  GrowingArray<int> other = std::move(array);
  EXPECT_EQ(other[1], 5);
  other = GrowingArray<int>(1);
  EXPECT_EQ(other.size(), 1U);
}

}  // namespace
}  // namespace kintsugi
