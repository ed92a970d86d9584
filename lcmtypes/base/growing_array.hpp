#pragma once

#include <cassert>
#include <cstddef>
#include <new>
#include <span>
#include <type_traits>
#include <utility>

#include "lcmtypes/base/reserved_memory.hpp"

namespace kintsugi {

/// A contiguous array that never moves when it grows: its address range is reserved once, for as
/// many elements as a 32-bit index can address, and memory is taken as it grows. A map of millions
/// of points thus grows without the pauses of a vector that copies itself, and references into the
/// array stay valid. New elements are zero bytes until assigned.
template <typename T>
class GrowingArray {
  static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);

 public:
  GrowingArray() = default;
  /// @throws std::bad_alloc when the address space is limited
  explicit GrowingArray(std::size_t size) { resize(size); }
  GrowingArray(GrowingArray&& other) noexcept { swap(other); }
  GrowingArray& operator=(GrowingArray&& other) noexcept {
    GrowingArray(std::move(other)).swap(*this);
    return *this;
  }
  GrowingArray(const GrowingArray&) = delete;
  GrowingArray& operator=(const GrowingArray&) = delete;
  ~GrowingArray() = default;

  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  T* data() { return data_; }
  const T* data() const { return data_; }
  T* begin() { return data_; }
  T* end() { return data_ + size_; }
  const T* begin() const { return data_; }
  const T* end() const { return data_ + size_; }
  T& operator[](std::size_t i) {
    assert(i < size_);
    return data_[i];
  }
  const T& operator[](std::size_t i) const {
    assert(i < size_);
    return data_[i];
  }
  T& back() { return (*this)[size_ - 1]; }
  std::span<const T> span() const { return {data_, size_}; }

  /// Grows; `size` must be at least size().
  /// @throws std::bad_alloc, and changes nothing, when there is no more memory
  void resize(std::size_t size) {
    assert(size >= size_);
    if (size > capacity_) commit(size);
    size_ = size;
  }
  void resize(std::size_t size, const T& value) {
    const std::size_t old = size_;
    resize(size);
    for (std::size_t i = old; i < size; ++i) data_[i] = value;
  }
  /// Sets the size to 0 and keeps the memory: elements added later have their old values until
  /// they are assigned.
  void clear() { size_ = 0; }
  T& push_back(const T& value) {
    resize(size_ + 1);
    return back() = value;
  }

  /// From now on what is not used for long may go to disk (SwapSpace), which must outlive the
  /// array.
  void swap_to(SwapSpace& space) {
    if (data_ == nullptr) reserve();
    memory_.swap_to(space);
  }

  /// Memory taken so far.
  std::size_t bytes() const { return capacity_ * sizeof(T); }

 private:
  static constexpr std::size_t kReservedBytes = (std::size_t{1} << 32) * sizeof(T);

  void reserve() {
    memory_ = ReservedMemory(kReservedBytes, ReservedMemory::HugePages::kAfterTheFirst);
    data_ = reinterpret_cast<T*>(memory_.data());
  }

  void commit(std::size_t size) {
    if (data_ == nullptr) reserve();
    memory_.commit(size * sizeof(T));
    capacity_ = memory_.committed_bytes() / sizeof(T);
  }

  void swap(GrowingArray& other) noexcept {
    std::swap(memory_, other.memory_);
    std::swap(data_, other.data_);
    std::swap(size_, other.size_);
    std::swap(capacity_, other.capacity_);
  }

  ReservedMemory memory_;
  T* data_ = nullptr;  ///< the start of memory_
  std::size_t size_ = 0;
  std::size_t capacity_ = 0;
};

}  // namespace kintsugi
