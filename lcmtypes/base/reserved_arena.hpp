#pragma once

#include <cstddef>
#include <memory_resource>

#include "lcmtypes/base/reserved_memory.hpp"

namespace kintsugi {

/// Memory of a reserved range for a pool of the standard library, which keeps what it was given
/// until its end: nothing is given back before. So what lies in the pool may go to disk.
class ReservedArena final : public std::pmr::memory_resource {
 public:
  /// @throws std::bad_alloc when the address space is limited
  ReservedArena() : memory_(kReservedBytes, ReservedMemory::HugePages::kAfterTheFirst) {}

  void swap_to(SwapSpace& space) { memory_.swap_to(space); }
  std::size_t bytes() const { return memory_.committed_bytes(); }

 private:
  static constexpr std::size_t kReservedBytes = std::size_t{1} << 38;

  void* do_allocate(std::size_t bytes, std::size_t alignment) override {
    const std::size_t begin = (used_bytes_ + alignment - 1) / alignment * alignment;
    memory_.commit(begin + bytes);
    used_bytes_ = begin + bytes;
    return memory_.data() + begin;
  }
  void do_deallocate(void* /*p*/, std::size_t /*bytes*/, std::size_t /*alignment*/) override {}
  bool do_is_equal(const memory_resource& other) const noexcept override { return this == &other; }

  ReservedMemory memory_;
  std::size_t used_bytes_ = 0;
};

}  // namespace kintsugi
