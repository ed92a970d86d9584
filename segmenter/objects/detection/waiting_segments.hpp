#pragma once
// Which segment is examined next.

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <vector>

namespace kintsugi::segmenter {

/// Segments that have changed. Those that have changed much since they were last examined come
/// first, since little changes when a few points come or go; else the one that has waited longest.
/// When that has waited for kPatience_us, it has every second turn: while somebody walks, there is
/// always one that has changed much, and the last part of an object that comes into view is seldom
/// much of it.
class WaitingSegments {
 public:
  /// Of device time: the camera, at walking pace, has passed a thing by then.
  static constexpr std::int64_t kPatience_us = 5'000'000;

  /// A segment that has changed, or on which something that has changed may depend.
  /// @param num_points of the segment now; with 0 it comes before all others: it takes no time, and
  ///   what was recognised there must not compete with what is recognised now
  /// @param utime device time of the map, microseconds
  /// @param is_urgent whatever its number of points
  void add(std::uint32_t segment, std::int64_t num_points, std::int64_t utime,
           bool is_urgent = false);
  /// Takes out the next one. There must be one.
  std::uint32_t pop();
  /// Forgets a segment that does not exist any more.
  void erase(std::uint32_t segment);
  void clear();
  /// All of them: those first that have changed much, then by how long they have waited.
  [[nodiscard]] std::vector<std::uint32_t> in_order() const;

  /// Whether so many points are another segment than was examined last.
  [[nodiscard]] bool has_changed_much(std::uint32_t segment, std::int64_t num_points) const;
  [[nodiscard]] bool contains(std::uint32_t segment) const { return waiting_.contains(segment); }
  [[nodiscard]] bool empty() const { return waiting_.empty(); }
  [[nodiscard]] std::size_t size() const { return waiting_.size(); }
  /// Since when the next one waits; nothing: none waits.
  [[nodiscard]] std::optional<std::int64_t> since_us() const;

 private:
  struct Waiting {
    std::int64_t since_us = 0;
    std::int64_t num_points = 0;
    bool is_urgent = false;
  };

  [[nodiscard]] bool is_turn_of_others() const;

  std::map<std::uint32_t, Waiting> waiting_;
  std::deque<std::uint32_t> urgent_;
  std::deque<std::uint32_t> others_;                // ascending by when they came
  bool was_urgent_ = false;                         // the one that was examined last
  std::int64_t now_us_ = 0;                         // device time of the newest change
  std::map<std::uint32_t, std::int64_t> examined_;  // its points then
};

}  // namespace kintsugi::segmenter
