#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "segmenter/core/exact/join_rule.hpp"
#include "tests/fuzz/random.hpp"

namespace kintsugi::segmenter::exact {
namespace {

constexpr double kT = 0.001;
constexpr double kK = 0.0005;

float next_float(float x) { return std::nextafter(x, std::numeric_limits<float>::infinity()); }

/// Whether a component of `size` points, joined last at `weight`, is alive at `next_weight`: what
/// Algorithm 1 asks, one point taken for a join, too.
bool is_alive(const JoinRule& rule, float weight, float next_weight, std::int64_t size) {
  return static_cast<double>(next_weight) <
         static_cast<double>(weight) + rule.scale / static_cast<double>(size);
}

/// By trying one size after the other, up to `limit`.
std::int64_t capacity_by_trial(const JoinRule& rule, float weight, float next_weight,
                               std::int64_t limit) {
  std::int64_t size = 1;
  while (size < limit && is_alive(rule, weight, next_weight, size + 1)) ++size;
  return size;
}

/// theta falls as the size grows, so that the largest size is where the predicate turns.
void expect_capacity_is_largest(const JoinRule& rule, float weight, float next_weight) {
  const std::int64_t capacity = rule.capacity(weight, next_weight);
  SCOPED_TRACE(::testing::Message() << std::hexfloat << "k " << rule.scale << ", from " << weight
                                    << " to " << next_weight << ": " << capacity);
  ASSERT_GE(capacity, 1);
  if (capacity == JoinRule::kUnbounded) {
    // As many points as a map can have, but for a few.
    EXPECT_TRUE(is_alive(rule, weight, next_weight, JoinRule::kUnbounded - 4));
    return;
  }
  if (capacity > 1) {
    EXPECT_TRUE(is_alive(rule, weight, next_weight, capacity));
  }
  EXPECT_FALSE(is_alive(rule, weight, next_weight, capacity + 1));
  constexpr std::int64_t kFew = 3000;
  if (capacity < kFew) {
    EXPECT_EQ(capacity, capacity_by_trial(rule, weight, next_weight, kFew));
  }
}

TEST(JoinRule, ThetaIsThatOfTheEquation) {
  const JoinRule rule{kT, kK};
  EXPECT_EQ(rule.theta(0.0F, 1), kT);
  EXPECT_EQ(rule.theta(0.25F, 2), 0.25 + kK / 2.0);
  EXPECT_EQ(rule.theta(0.0F, 1'000'000), kK / 1e6);
}

TEST(JoinRule, CapacityInRoundNumbers) {
  // k / n is above 1/8 up to 7 points, and equal to it at 8: no longer alive.
  const JoinRule rule{kT, 1.0};
  EXPECT_EQ(rule.capacity(0.5F, 0.625F), 7);
  EXPECT_EQ(rule.capacity(0.5F, next_float(0.625F)), 7);
  EXPECT_EQ(rule.capacity(0.5F, std::nextafter(0.625F, 0.0F)), 8);
  EXPECT_EQ(rule.capacity(0.0F, 0.25F), 3);
}

TEST(JoinRule, CapacityIsAtLeastOne) {
  EXPECT_EQ((JoinRule{kT, kK}.capacity(0.0F, 1.0F)), 1);
  EXPECT_EQ((JoinRule{kT, kK}.capacity(0.0001F, std::numeric_limits<float>::max())), 1);
}

TEST(JoinRule, CapacityOfEqualWeightsIsUnbounded) {
  const JoinRule rule{kT, kK};
  for (const float weight : {0.0F, 1e-30F, 0.0004F, 0.0015F}) {
    EXPECT_EQ(rule.capacity(weight, weight), JoinRule::kUnbounded);
    expect_capacity_is_largest(rule, weight, weight);
  }
}

TEST(JoinRule, CapacityOfEqualWeightsIsBoundedWhereKVanishesBesideThem) {
  // theta of size points is the weight itself once k / size is below half its last bit.
  fuzz::Random random(4);
  for (int n = 0; n < 1000; ++n) {
    const JoinRule rule{kT, random.log_uniform(1e-24, 1e-8)};
    const auto weight = static_cast<float>(random.log_uniform(1e-6, 1e-3));
    expect_capacity_is_largest(rule, weight, weight);
  }
  EXPECT_EQ((JoinRule{kT, 1e-22}.capacity(1e-4F, 1e-4F)), 1);
}

TEST(JoinRule, CapacityIsLargestForRandomWeights) {
  fuzz::Random random(1);
  for (int n = 0; n < 20'000; ++n) {
    const JoinRule rule{kT, random.chance(0.5) ? kK : random.log_uniform(1e-6, 10.0)};
    const auto weight = static_cast<float>(random.log_uniform(1e-9, 2e-3));
    const auto rise = static_cast<float>(random.log_uniform(1e-9, 2e-3));
    expect_capacity_is_largest(rule, weight, weight + rise);
  }
}

TEST(JoinRule, CapacityIsLargestForNeighbouringFloats) {
  fuzz::Random random(2);
  for (int n = 0; n < 20'000; ++n) {
    const JoinRule rule{kT, random.log_uniform(1e-12, 10.0)};
    const auto weight = static_cast<float>(random.log_uniform(1e-9, 4.0));
    float next_weight = next_float(weight);
    for (std::size_t ulps = random.below(4); ulps > 0; --ulps) {
      next_weight = next_float(next_weight);
    }
    expect_capacity_is_largest(rule, weight, next_weight);
  }
}

TEST(JoinRule, CapacityIsLargestWhereTheNextWeightIsAboutTheta) {
  // The next weight is what theta of some size is, rounded to a float, or a neighbour of that.
  fuzz::Random random(3);
  for (int n = 0; n < 20'000; ++n) {
    const JoinRule rule{kT, random.chance(0.5) ? kK : random.log_uniform(1e-6, 10.0)};
    const auto weight = static_cast<float>(random.log_uniform(1e-7, 2e-3));
    const auto size = static_cast<std::uint32_t>(random.log_uniform(2.0, 1e8));
    const auto theta = static_cast<float>(rule.theta(weight, size));
    for (const float next_weight : {std::nextafter(theta, 0.0F), theta, next_float(theta)}) {
      if (next_weight > weight) expect_capacity_is_largest(rule, weight, next_weight);
    }
  }
}

TEST(JoinRule, CapacityIsLargestForTinyWeights) {
  const JoinRule rule{kT, kK};
  const float tiniest = std::numeric_limits<float>::denorm_min();
  expect_capacity_is_largest(rule, 0.0F, tiniest);
  expect_capacity_is_largest(rule, tiniest, next_float(tiniest));
  expect_capacity_is_largest(rule, 0.0F, std::numeric_limits<float>::min());
}

}  // namespace
}  // namespace kintsugi::segmenter::exact
