#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "lcmtypes/base/process_memory.hpp"

namespace kintsugi {
namespace {

constexpr std::int64_t kMb = 1 << 20;

// Blocks that the heap does not map one by one. Something at its end is still in use.
TEST(ProcessMemory, FreeMemoryInTheMiddleOfTheHeapIsReturned) {
#if defined(__SANITIZE_THREAD__) || defined(__SANITIZE_ADDRESS__)
  GTEST_SKIP() << "a sanitizer has a heap of its own";
#endif
  constexpr std::size_t kBlock = 16 << 10;
  std::vector<std::unique_ptr<std::vector<char>>> blocks(64 * kMb / kBlock);
  for (auto& block : blocks) block = std::make_unique<std::vector<char>>(kBlock, 'x');
  const auto last = std::make_unique<std::vector<char>>(kBlock, 'x');
  blocks.clear();
  const std::int64_t before = process_memory().resident_bytes;
  return_free_memory();
  EXPECT_LT(process_memory().resident_bytes, before - 48 * kMb);
  EXPECT_EQ(last->back(), 'x');
}

}  // namespace
}  // namespace kintsugi
