#pragma once

#include <cstddef>

namespace kintsugi::mapper {

/// A range of addresses that is reserved once and never moves; memory is taken as it is needed.
/// What is in it can therefore be found by an index from its start, however much there will be.
class ReservedMemory {
 public:
  /// Takes no memory. @throws std::bad_alloc where the address space is limited
  explicit ReservedMemory(std::size_t reserved_bytes);
  ReservedMemory(ReservedMemory&& other) noexcept;
  ReservedMemory& operator=(ReservedMemory&& other) noexcept;
  ReservedMemory(const ReservedMemory&) = delete;
  ReservedMemory& operator=(const ReservedMemory&) = delete;
  ~ReservedMemory();

  std::byte* data() { return data_; }
  const std::byte* data() const { return data_; }
  std::size_t committed_bytes() const { return committed_bytes_; }

  /// Makes at least the first `bytes` usable; those that were not before are zero.
  /// @throws std::bad_alloc where there is no more memory or the range ends before
  void commit(std::size_t bytes);

  /// Gives all memory back. Nothing is usable then.
  void release();

 private:
  void* range_ = nullptr;  ///< as the system gave it
  std::size_t range_bytes_ = 0;
  std::byte* data_ = nullptr;  ///< in it, at the start of a huge page
  std::size_t reserved_bytes_ = 0;
  std::size_t committed_bytes_ = 0;
};

}  // namespace kintsugi::mapper
