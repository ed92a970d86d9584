#include <cstdint>
#include <cstring>
#include <new>
#include <utility>

#include <gtest/gtest.h>

#include "lcmtypes/base/reserved_memory.hpp"

namespace kintsugi {
namespace {

TEST(ReservedMemory, GrowsInPlaceAndStartsAtZero) {
  ReservedMemory memory(std::size_t{1} << 33);
  EXPECT_EQ(memory.committed_bytes(), 0U);
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(memory.data()) % (1U << 21), 0U);
  memory.commit(1);
  std::byte* const start = memory.data();
  start[0] = std::byte{7};
  memory.commit(10'000'000);
  EXPECT_EQ(memory.data(), start);
  EXPECT_EQ(start[0], std::byte{7});
  EXPECT_EQ(start[9'999'999], std::byte{0});
  EXPECT_GE(memory.committed_bytes(), 10'000'000U);
}

TEST(ReservedMemory, IsZeroAgainAfterRelease) {
  ReservedMemory memory(std::size_t{1} << 24);
  memory.commit(1000);
  std::memset(memory.data(), 0xFF, 1000);
  memory.release();
  EXPECT_EQ(memory.committed_bytes(), 0U);
  memory.commit(1000);
  EXPECT_EQ(memory.data()[999], std::byte{0});
}

TEST(ReservedMemory, OnlyADiscardedPageIsZeroAgain) {
  constexpr std::size_t kPage = ReservedMemory::kPageBytes;
  ReservedMemory memory(4 * kPage);
  memory.commit(3 * kPage);
  std::memset(memory.data(), 0xFF, 3 * kPage);
  memory.discard_page(1);
  memory.discard_page(3);  // not committed: nothing happens
  EXPECT_EQ(memory.data()[kPage - 1], std::byte{0xFF});
  EXPECT_EQ(memory.data()[kPage], std::byte{0});
  EXPECT_EQ(memory.data()[2 * kPage - 1], std::byte{0});
  EXPECT_EQ(memory.data()[2 * kPage], std::byte{0xFF});
}

TEST(ReservedMemory, ThrowsBeyondTheReservedRange) {
  ReservedMemory memory(5000);
  memory.commit(5000);
  EXPECT_EQ(memory.committed_bytes(), 5000U);
  EXPECT_THROW(memory.commit(5001), std::bad_alloc);
}

TEST(ReservedMemory, SaysThatAddressesAreLacking) {
  try {
    const ReservedMemory memory(std::size_t{1} << 60);
    FAIL() << "more than a process has";
  } catch (const std::bad_alloc& error) {
    EXPECT_STREQ(error.what(),
                 "the process has no addresses left for another map: too many maps, or a limit "
                 "(ulimit -v)");
  }
}

TEST(ReservedMemory, CanBeMoved) {
  ReservedMemory memory(5000);
  memory.commit(10);
  memory.data()[3] = std::byte{9};
  ReservedMemory moved(std::move(memory));
  EXPECT_EQ(moved.data()[3], std::byte{9});
  ReservedMemory assigned(100);
  assigned = std::move(moved);
  EXPECT_EQ(assigned.data()[3], std::byte{9});
}

}  // namespace
}  // namespace kintsugi
