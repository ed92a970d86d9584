#pragma once
// Counts allocated memory. The library kintsugi_allocation_limit replaces operator new.

#include <cstddef>

namespace kintsugi::testing {

/// Bytes that the program has allocated so far, freed or not.
std::size_t allocated_bytes();

/// Bytes that `function` allocates, freed or not.
template <class Function>
std::size_t allocated_by(const Function& function) {
  const std::size_t before = allocated_bytes();
  function();
  return allocated_bytes() - before;
}

}  // namespace kintsugi::testing
