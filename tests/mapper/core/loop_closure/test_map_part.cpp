#include <vector>

#include <gtest/gtest.h>

#include "mapper/core/loop_closure/map_part.hpp"

namespace kintsugi::mapper {
namespace {

TEST(OriginOfPart, IsAKilometreFromAnyOther) {
  std::vector<Eigen::Vector3d> origins;
  for (int part = 0; part < 400; ++part) {
    const Pose X_WP = origin_of_part(part);
    EXPECT_TRUE(X_WP.linear().isIdentity());
    for (const Eigen::Vector3d& other : origins) {
      ASSERT_GE((X_WP.translation() - other).norm(), 1'000.0) << part;
    }
    origins.push_back(X_WP.translation());
  }
  EXPECT_TRUE(origins.front().isZero());
}

TEST(OriginOfPart, StaysNearTheFirst) {
  const auto farthest_m = [](int part) {
    return origin_of_part(part).translation().lpNorm<Eigen::Infinity>();
  };
  for (int part = 1; part < 27; ++part) EXPECT_EQ(farthest_m(part), 1'000.0);
  EXPECT_EQ(farthest_m(27), 2'000.0);
  EXPECT_EQ(farthest_m(1'330), 5'000.0);
}

}  // namespace
}  // namespace kintsugi::mapper
