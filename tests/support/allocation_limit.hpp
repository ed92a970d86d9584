#pragma once
// Counts what is allocated: include in one .cpp of a test program, it replaces operator new.

#include <atomic>
#include <cstdlib>
#include <new>

namespace kintsugi::testing {

inline std::atomic<std::size_t> g_allocated_bytes{0};

/// Bytes allocated by `function`, freed again or not.
template <class Function>
std::size_t allocated_by(const Function& function) {
  const std::size_t before = g_allocated_bytes;
  function();
  return g_allocated_bytes - before;
}

}  // namespace kintsugi::testing

// Not inlined: the compiler would see free() beside its own idea of operator new, and warn.
// NOLINTBEGIN: this is the allocator
// All that come in pairs with one operator delete, or the address sanitizer would see a mismatch.
[[gnu::noinline]] void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  kintsugi::testing::g_allocated_bytes += size;
  return std::malloc(size);
}
[[gnu::noinline]] void* operator new(std::size_t size) {
  if (void* memory = operator new(size, std::nothrow)) return memory;
  throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
// NOLINTEND
