#include <gtest/gtest.h>

#include "lcmtypes/stream/token_bucket.hpp"

namespace kintsugi {
namespace {

TEST(TokenBucket, AllowsTheBurstAtOnceAndThenTheRate) {
  TokenBucket bucket(1000.0, 500.0);
  EXPECT_EQ(bucket.delay_s(500.0, 0.0), 0.0);
  bucket.take(500.0, 0.0);
  EXPECT_DOUBLE_EQ(bucket.delay_s(250.0, 0.0), 0.25);
  EXPECT_DOUBLE_EQ(bucket.delay_s(250.0, 0.125), 0.125);
  EXPECT_EQ(bucket.delay_s(250.0, 0.25), 0.0);
}

TEST(TokenBucket, NeverSavesMoreThanTheBurst) {
  TokenBucket bucket(1000.0, 500.0);
  bucket.take(500.0, 1e6);
  EXPECT_DOUBLE_EQ(bucket.delay_s(500.0, 1e6), 0.5);
}

TEST(TokenBucket, AMessageLargerThanTheBurstDelaysTheNextOne) {
  TokenBucket bucket(1000.0, 500.0);
  EXPECT_EQ(bucket.delay_s(2000.0, 0.0), 0.0);
  bucket.take(2000.0, 0.0);
  EXPECT_DOUBLE_EQ(bucket.delay_s(500.0, 0.0), 2.0);
}

TEST(TokenBucket, KeepsTheRateOverAnyNumberOfMessages) {
  TokenBucket bucket(1e6, 100'000.0);
  double now_s = 0.0;
  for (int i = 0; i < 1000; ++i) {
    now_s += bucket.delay_s(60'000.0, now_s);
    bucket.take(60'000.0, now_s);
  }
  // All but the burst had to wait; the tolerance is the rounding of a thousand sums.
  EXPECT_NEAR(now_s, (1000 * 60'000.0 - 100'000.0) / 1e6, 1e-9);
}

}  // namespace
}  // namespace kintsugi
