#include "tests/support/allocation_limit.hpp"

#include <atomic>
#include <cstdlib>
#include <new>

namespace kintsugi::testing {
namespace {

std::atomic<std::size_t> g_allocated_bytes{0};

void* allocate(std::size_t size) {
  g_allocated_bytes += size;
  return std::malloc(size);  // NOLINT: this is the allocator
}

}  // namespace

std::size_t allocated_bytes() { return g_allocated_bytes; }

}  // namespace kintsugi::testing

// Every form of operator new that is paired with one of these operator delete, or the address
// sanitizer would report a mismatch. Not inlined: the compiler would warn of free() for memory of
// its own operator new.
// NOLINTBEGIN: this is the allocator
[[gnu::noinline]] void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  return kintsugi::testing::allocate(size);
}
[[gnu::noinline]] void* operator new(std::size_t size) {
  if (void* memory = kintsugi::testing::allocate(size)) return memory;
  throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
// NOLINTEND
