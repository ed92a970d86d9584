#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <memory_resource>
#include <random>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "lcmtypes/base/growing_array.hpp"
#include "lcmtypes/base/process_memory.hpp"
#include "lcmtypes/base/reserved_arena.hpp"
#include "lcmtypes/base/swap_space.hpp"
#include "tests/support/file_size_limit.hpp"
#include "tests/support/temporary_folder.hpp"

namespace kintsugi {
namespace {

using testing::kOnDisk;
using testing::TemporaryFolder;

constexpr std::size_t kMillion = 1'000'000;
constexpr std::size_t kAlways = 1;  ///< a limit that the process is always above

std::uint64_t value_of(std::size_t i) { return 0x9E3779B97F4A7C15U * (i + 1); }

void trim_all(SwapSpace& space) {
  for (int k = 0; k < 20; ++k) space.trim();
}

/// Values in [first, last) that are not those of value_of(), shifted by `by`.
std::size_t num_wrong(const GrowingArray<std::uint64_t>& array, std::uint64_t by = 0) {
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < array.size(); ++i) wrong += array[i] == value_of(i) + by ? 0 : 1;
  return wrong;
}

TEST(SwapSpace, KeepsWhatIsOnDiskAndFreesItsMemory) {
  const TemporaryFolder folder(kOnDisk);
  SwapSpace space({folder.path(), kAlways});
  GrowingArray<std::uint64_t> array;
  array.swap_to(space);
  for (std::size_t i = 0; i < 8 * kMillion; ++i) array.push_back(value_of(i));
  const std::int64_t before = process_memory().resident_bytes;
  trim_all(space);
  const std::int64_t after = process_memory().resident_bytes;
  EXPECT_GE(before - after, 55 << 20);  // of the 64 MB
  EXPECT_GE(space.file_bytes(), 64 * kMillion);
  EXPECT_EQ(num_wrong(array), 0U);
  EXPECT_EQ(space.problem(), "");
}

TEST(SwapSpace, KeepsChangesOfWhatWasOnDisk) {
  const TemporaryFolder folder(kOnDisk);
  SwapSpace space({folder.path(), kAlways});
  GrowingArray<std::uint64_t> array;
  array.swap_to(space);
  std::vector<std::uint64_t> expected;
  std::mt19937 random(7);  // NOLINT(*-msc51-cpp): the same in every run
  for (int round = 0; round < 30; ++round) {
    for (std::size_t k = 0; k < 100'000; ++k) {
      expected.push_back(random());
      array.push_back(expected.back());
    }
    for (int k = 0; k < 300; ++k) {
      const std::size_t i = random() % expected.size();
      array[i] = expected[i] = random();
    }
    space.trim();
  }
  EXPECT_TRUE(std::equal(array.begin(), array.end(), expected.begin(), expected.end()));
}

TEST(SwapSpace, WritesOnlyWhatHasChanged) {
  const TemporaryFolder folder(kOnDisk);
  SwapSpace space({folder.path(), kAlways});
  GrowingArray<std::uint64_t> array(4 * kMillion);
  array.swap_to(space);
  for (std::size_t i = 0; i < array.size(); ++i) array[i] = value_of(i);
  trim_all(space);
  const std::size_t written = space.written_bytes();
  EXPECT_EQ(num_wrong(array), 0U);  // reads all of it
  trim_all(space);
  EXPECT_EQ(space.written_bytes(), written);
  array[3 * kMillion] += 1;
  trim_all(space);
  EXPECT_EQ(space.written_bytes(), written + 4096);
}

TEST(SwapSpace, StaysBelowTheLimitWhileAnArrayGrows) {
  const TemporaryFolder folder(kOnDisk);
  const auto limit = static_cast<std::size_t>(process_memory().anonymous_bytes) + (64U << 20);
  SwapSpace space({folder.path(), limit});
  GrowingArray<std::uint64_t> array;
  array.swap_to(space);
  for (std::size_t i = 0; i < 30 * kMillion; ++i) {  // 240 MB
    array.push_back(value_of(i));
    if (i % 100'000 != 0) continue;
    space.trim();
    ASSERT_LE(process_memory().anonymous_bytes, static_cast<std::int64_t>(limit) + (8 << 20));
  }
}

TEST(SwapSpace, SeldomWritesWhatIsAlwaysInUse) {
#ifdef __SANITIZE_THREAD__
  GTEST_SKIP() << "the thread sanitizer takes several times the memory that is in use, beside it";
#endif
  constexpr std::size_t kValuesOfChunk = SwapSpace::kChunkBytes / sizeof(std::uint64_t);
  constexpr std::size_t kChunksInUse = 8;
  const TemporaryFolder folder(kOnDisk);
  const auto limit = static_cast<std::size_t>(process_memory().anonymous_bytes) + (48U << 20);
  SwapSpace space({folder.path(), limit});
  GrowingArray<std::uint64_t> in_use(kChunksInUse * kValuesOfChunk);
  GrowingArray<std::uint64_t> growing;
  in_use.swap_to(space);
  growing.swap_to(space);
  for (std::size_t step = 0; step < 200; ++step) {
    for (std::size_t i = 0; i < in_use.size(); ++i) in_use[i] = value_of(i) + step;
    for (std::size_t k = 0; k < kValuesOfChunk; ++k) growing.push_back(value_of(growing.size()));
    space.trim();
  }
  EXPECT_EQ(num_wrong(in_use, 199), 0U);
  EXPECT_EQ(num_wrong(growing), 0U);
  // The limit has room for 16 steps beside what is in use: it would be written 12 times.
  EXPECT_LE(space.written_bytes(), (growing.size() + 5 * in_use.size()) * sizeof(std::uint64_t));
}

TEST(SwapSpace, DoesNothingBelowTheLimit) {
  const TemporaryFolder folder(kOnDisk);
  SwapSpace space({folder.path(), std::size_t{1} << 50});
  GrowingArray<std::uint64_t> array(kMillion);
  array.swap_to(space);
  space.trim();
  EXPECT_EQ(space.file_bytes(), 0U);
}

TEST(SwapSpace, ReadersMayReadMeanwhile) {
  const TemporaryFolder folder(kOnDisk);
  SwapSpace space({folder.path(), kAlways});
  GrowingArray<std::uint64_t> array(2 * kMillion);
  array.swap_to(space);
  for (std::size_t i = 0; i < array.size(); ++i) array[i] = value_of(i);
  std::size_t wrong = 0;
  std::thread reader([&] {
    for (int k = 0; k < 10; ++k) wrong += num_wrong(array);
  });
  for (int k = 0; k < 50; ++k) space.trim();
  reader.join();
  EXPECT_EQ(wrong, 0U);
}

TEST(SwapSpace, UsesThePlaceOfAnArrayThatIsGoneAgain) {
  const TemporaryFolder folder(kOnDisk);
  SwapSpace space({folder.path(), kAlways});
  for (std::uint64_t round = 0; round < 3; ++round) {
    GrowingArray<std::uint64_t> array;
    array.swap_to(space);
    array.resize(kMillion);
    EXPECT_EQ(array[kMillion - 1], 0U);
    for (std::size_t i = 0; i < array.size(); ++i) array[i] = value_of(i) + round;
    trim_all(space);
    array.resize(kMillion + 200'000);  // within the last chunk and beyond it
    EXPECT_EQ(array[kMillion + 100'000], 0U);
    EXPECT_EQ(array[kMillion - 1], value_of(kMillion - 1) + round);
  }
  EXPECT_LE(space.file_bytes(), 12U << 20);
}

TEST(SwapSpace, TakesWhatWasThereBeforeAndGoesAlongWithAMove) {
  const TemporaryFolder folder(kOnDisk);
  SwapSpace space({folder.path(), kAlways});
  GrowingArray<std::uint64_t> array(kMillion);
  for (std::size_t i = 0; i < array.size(); ++i) array[i] = value_of(i);
  array.swap_to(space);
  GrowingArray<std::uint64_t> other = std::move(array);
  trim_all(space);
  EXPECT_EQ(num_wrong(other), 0U);
  EXPECT_GE(space.file_bytes(), 8 * kMillion);
}

TEST(SwapSpace, TakesWhatLiesInAPool) {
  const TemporaryFolder folder(kOnDisk);
  SwapSpace space({folder.path(), kAlways});
  ReservedArena arena;
  std::pmr::synchronized_pool_resource pool(&arena);
  arena.swap_to(space);
  std::vector<std::pmr::vector<std::uint64_t>> runs;
  for (std::size_t k = 0; k < 5'000; ++k) {
    runs.emplace_back(&pool);
    for (std::size_t i = 0; i < k % 200; ++i) runs.back().push_back(value_of(k) + i);
    if (k % 500 == 0) space.trim();
  }
  std::size_t wrong = 0;
  for (std::size_t k = 0; k < runs.size(); ++k) {
    for (std::size_t i = 0; i < runs[k].size(); ++i) wrong += runs[k][i] == value_of(k) + i ? 0 : 1;
  }
  EXPECT_EQ(wrong, 0U);
}

TEST(SwapSpace, KeepsAllInMemoryWhileTheDiskIsFull) {
  const TemporaryFolder folder(kOnDisk);
  SwapSpace space({folder.path(), kAlways});
  GrowingArray<std::uint64_t> array(2 * kMillion);
  array.swap_to(space);
  for (std::size_t i = 0; i < array.size(); ++i) array[i] = value_of(i);
  {
    const testing::FileSizeLimit full(5U << 20);
    trim_all(space);
    EXPECT_NE(space.problem().find(folder.path().string()), std::string::npos) << space.problem();
    EXPECT_EQ(num_wrong(array), 0U);
  }
  trim_all(space);
  EXPECT_EQ(space.problem(), "");
  EXPECT_GE(space.file_bytes(), 16 * kMillion);
  EXPECT_EQ(num_wrong(array), 0U);
}

TEST(SwapSpace, LeavesNoFile) {
  const TemporaryFolder folder(kOnDisk);
  SwapSpace space({folder.path(), kAlways});
  GrowingArray<std::uint64_t> array(kMillion);
  array.swap_to(space);
  space.trim();
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(SwapSpace, RefusesAFolderThatIsNotThere) {
  try {
    const SwapSpace space({"/no/such/folder", kAlways});
    FAIL() << "expected std::runtime_error";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("/no/such/folder"), std::string::npos);
  }
}

TEST(SwapSpace, RefusesMemoryAsADisk) {
  if (!std::filesystem::exists("/dev/shm")) GTEST_SKIP() << "no /dev/shm";
  try {
    const SwapSpace space({"/dev/shm", kAlways});
    FAIL() << "expected std::runtime_error";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("tmpfs"), std::string::npos) << error.what();
  }
}

TEST(SwapSpace, RefusesALimitOfZero) { EXPECT_THROW(SwapSpace({".", 0}), std::invalid_argument); }

}  // namespace
}  // namespace kintsugi
