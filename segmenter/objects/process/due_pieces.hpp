#pragma once
// Which pieces of a map are still to be taken.

#include <cstddef>
#include <cstdint>
#include <set>

namespace kintsugi::segmenter {

/// Pieces that have changed. One that cannot be taken yet is tried again when it has changed again,
/// since looking at the labels of all points in each turn costs more than following the map.
class DuePieces {
 public:
  /// The piece has changed.
  void add(std::int32_t piece) { due_.insert(piece); }
  /// What could not be taken may be taken now.
  void try_all() { due_.merge(put_off_); }
  void clear() {
    due_.clear();
    put_off_.clear();
  }
  /// Nothing is to be tried.
  [[nodiscard]] bool empty() const { return due_.empty(); }

  /// Calls take(piece) for each that is due, ascending; false: it cannot be taken yet.
  /// @return how many were taken
  template <class Take>
  std::size_t take_each(const Take& take) {
    std::size_t num_taken = 0;
    for (const std::int32_t piece : due_) {
      if (take(piece)) {
        ++num_taken;
        put_off_.erase(piece);
      } else {
        put_off_.insert(piece);
      }
    }
    due_.clear();
    return num_taken;
  }

 private:
  std::set<std::int32_t> due_;
  std::set<std::int32_t> put_off_;
};

}  // namespace kintsugi::segmenter
