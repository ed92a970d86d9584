#pragma once

#include <cstddef>

namespace kintsugi {

/// A range of addresses that is reserved once and never moves; memory is taken as it is needed.
/// References into it stay valid while it grows.
class ReservedMemory {
 public:
  /// Scattered reads in pages of 4 kB cost a page walk each, so huge pages are asked for. An array
  /// that may stay small leaves its first 2 MB in small pages and does not take a huge one whole.
  enum class HugePages { kEverywhere, kAfterTheFirst };

  /// No range; nothing can be committed.
  ReservedMemory() = default;
  /// Takes no memory yet. @throws std::bad_alloc where the address space is limited
  explicit ReservedMemory(std::size_t reserved_bytes,
                          HugePages huge_pages = HugePages::kEverywhere);
  ReservedMemory(ReservedMemory&& other) noexcept;
  ReservedMemory& operator=(ReservedMemory&& other) noexcept;
  ReservedMemory(const ReservedMemory&) = delete;
  ReservedMemory& operator=(const ReservedMemory&) = delete;
  ~ReservedMemory();

  std::byte* data() { return data_; }
  const std::byte* data() const { return data_; }
  std::size_t committed_bytes() const { return committed_bytes_; }

  /// Makes at least the first `bytes` usable; those that were not usable before are zero.
  /// @throws std::bad_alloc, and changes nothing, where memory or the range is exhausted
  void commit(std::size_t bytes);

  /// Gives all memory back; afterwards nothing is usable.
  void release();

 private:
  void* range_ = nullptr;  ///< as the system gave it
  std::size_t range_bytes_ = 0;
  std::byte* data_ = nullptr;  ///< in it, at the start of a huge page
  std::size_t reserved_bytes_ = 0;
  std::size_t committed_bytes_ = 0;
};

}  // namespace kintsugi
