#pragma once

#include <cstddef>

namespace kintsugi {

class SwapSpace;

/// A range of addresses that is reserved once and never moves; memory is taken as it is needed, and
/// references into it stay valid.
class ReservedMemory {
 public:
  /// The system is advised to use huge pages, because scattered reads in pages of 4 kB cost a page
  /// walk each. kAfterTheFirst leaves the first 2 MB in small pages, so that an array that stays
  /// small does not take a whole huge page.
  /// kNowhere is for an array of which only pages here and there are used.
  enum class HugePages { kEverywhere, kAfterTheFirst, kNowhere };

  static constexpr std::size_t kPageBytes = std::size_t{1} << 21;  ///< of a huge page

  /// Reserves nothing.
  ReservedMemory() = default;
  /// Takes no memory yet. @throws std::bad_alloc when the address space is limited
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

  /// Makes at least the first `bytes` usable; new ones are zero.
  /// @throws std::bad_alloc, and changes nothing, when memory or the range is exhausted
  void commit(std::size_t bytes);

  /// Gives the memory of a huge page back, which stays usable and is zero then; of the first one,
  /// page 0, and those after it.
  void discard_page(std::size_t page);

  /// Gives all memory back; then no byte is usable.
  void release();

  /// From now on the memory may go to disk (SwapSpace), which must outlive it, and is neither
  /// released nor discarded. The reserved range has to be a multiple of kPageBytes.
  void swap_to(SwapSpace& space);

 private:
  void add_to_swap(std::size_t first_byte);

  void* range_ = nullptr;  ///< from mmap
  std::size_t range_bytes_ = 0;
  std::byte* data_ = nullptr;  ///< the first huge page in range_
  std::size_t reserved_bytes_ = 0;
  std::size_t committed_bytes_ = 0;
  SwapSpace* swap_ = nullptr;  ///< null: all stays in memory
};

}  // namespace kintsugi
