#include <stdexcept>

#include <gtest/gtest.h>

#include "lcmtypes/stream/sent_store.hpp"

namespace kintsugi {
namespace {

Bytes chunk(std::int64_t sequence, std::size_t size) {
  return Bytes(size, static_cast<std::uint8_t>(sequence));
}

TEST(RecentChunks, KeepsTheNewestWithinItsLimit) {
  RecentChunks store(1'000);
  EXPECT_EQ(store.first_sequence(), 0);
  EXPECT_EQ(store.next_sequence(), 0);
  for (std::int64_t sequence = 0; sequence < 25; ++sequence) {
    store.add(sequence, chunk(sequence, 100));
    EXPECT_LE(store.bytes(), 1'000U);
  }
  EXPECT_EQ(store.first_sequence(), 15);
  EXPECT_EQ(store.next_sequence(), 25);
  EXPECT_FALSE(store.find(14));
  EXPECT_FALSE(store.find(25));
  EXPECT_FALSE(store.find(-1));
  for (std::int64_t sequence = 15; sequence < 25; ++sequence) {
    EXPECT_EQ(store.find(sequence), chunk(sequence, 100));
  }
}

TEST(RecentChunks, KeepsTheNewestEvenWhenItIsTooLarge) {
  RecentChunks store(1'000);
  store.add(0, chunk(0, 100));
  store.add(1, chunk(1, 5'000));
  EXPECT_EQ(store.first_sequence(), 1);
  EXPECT_EQ(store.find(1), chunk(1, 5'000));
}

TEST(RecentChunks, FollowsALimitThatChanges) {
  RecentChunks store(1'000);
  store.set_max_bytes(2'000);
  for (std::int64_t sequence = 0; sequence < 25; ++sequence) {
    store.add(sequence, chunk(sequence, 100));
  }
  EXPECT_EQ(store.first_sequence(), 5);
  store.set_max_bytes(300);
  store.add(25, chunk(25, 100));
  EXPECT_EQ(store.first_sequence(), 23);
}

TEST(RecentChunks, RefusesAGapInTheNumbers) {
  RecentChunks store(1'000);
  store.add(7, chunk(7, 10));
  EXPECT_THROW(store.add(9, chunk(9, 10)), std::invalid_argument);
  EXPECT_THROW(store.add(7, chunk(7, 10)), std::invalid_argument);
  EXPECT_EQ(store.next_sequence(), 8);
}

}  // namespace
}  // namespace kintsugi
