#pragma once
// Which segment is examined next.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

namespace kintsugi::segmenter {

/// Segments that have changed. First come those of which something was told that may be wrong now;
/// then those that have changed much since they were last examined, since little changes when a few
/// points come or go, and of these the one that is most like an object; else the one that has
/// waited longest. While somebody walks, there is always one that has changed much and is like an
/// object, and the last part of an object that comes into view is seldom much of it. So who has
/// waited too long has every second turn.
class WaitingSegments {
 public:
  /// So long may one wait that has changed little, of device time: the camera, at walking pace, has
  /// passed a thing by then.
  static constexpr std::int64_t kPatience_us = 5'000'000;
  /// And one that has changed much, but is less like an object than others: what a camera shows in
  /// some ten seconds of walking takes about a minute at the usual share of the processor.
  static constexpr std::int64_t kLongPatience_us = 60'000'000;

  struct Next {
    std::uint32_t segment = 0;
    std::int64_t since_us = 0;  ///< device time since which it has waited, microseconds
  };

  /// A segment that has changed, or on which something that has changed may depend.
  /// @param num_points of the segment now; with 0 it comes before all others: it takes no time, and
  ///   what was recognised there must not compete with what is recognised now
  /// @param utime device time of the map, microseconds
  /// @param is_urgent something was told of it that may be wrong now
  void add(std::uint32_t segment, std::int64_t num_points, std::int64_t utime,
           bool is_urgent = false);
  /// Those that have changed much and are not ranked yet, or have changed much since; ascending.
  /// They come before those that are.
  [[nodiscard]] std::vector<std::uint32_t> unranked() const;
  /// @param segment one of unranked()
  /// @param distance how unlike all objects it is
  void rank(std::uint32_t segment, float distance);
  /// If it waits, it is one of those that come first.
  void hurry(std::uint32_t segment);
  /// Takes out the next one. There must be one.
  Next pop();
  /// Forgets a segment that does not exist any more.
  void erase(std::uint32_t segment);
  /// None waits, and none was ever examined.
  void clear();

  /// Whether so many points are another segment than was examined last.
  [[nodiscard]] bool has_changed_much(std::uint32_t segment, std::int64_t num_points) const;
  [[nodiscard]] bool contains(std::uint32_t segment) const { return waiting_.contains(segment); }
  template <class Segments>
  [[nodiscard]] bool contains_any(const Segments& segments) const {
    return std::ranges::any_of(segments, [this](std::uint32_t id) { return contains(id); });
  }
  [[nodiscard]] bool empty() const { return waiting_.empty(); }
  [[nodiscard]] std::size_t size() const { return waiting_.size(); }

 private:
  enum class Turn : std::uint8_t { kFirst, kChangedMuch, kOther };
  /// Its turn, how unlike all objects it is, and when it came.
  using Place = std::tuple<Turn, float, std::int64_t>;
  struct Waiting {
    std::int64_t since_us = 0;
    std::int64_t num_points = 0;
    std::int64_t num_ranked = 0;  // of its points, when it was ranked
    Place place{Turn::kOther, 0.0F, 0};
  };

  void put(std::uint32_t segment, Waiting& waiting, Turn turn, float distance);
  void take_out_of_order(std::uint32_t segment, const Waiting& waiting);
  /// How long the one of a turn has waited that came first, in `patience_us`.
  [[nodiscard]] double impatience(Turn turn, std::int64_t patience_us) const;
  [[nodiscard]] std::uint32_t next() const;

  std::map<std::uint32_t, Waiting> waiting_;
  std::map<Place, std::uint32_t> in_order_;                              // of those that wait
  std::map<std::pair<Turn, std::int64_t>, std::uint32_t> as_they_came_;  // the same, of each turn
  std::set<std::uint32_t> unranked_;                                     // of these
  std::int64_t num_added_ = 0;
  bool was_turn_of_others_ = true;                  // of those that do not come first in order
  std::int64_t now_us_ = 0;                         // device time of the newest change
  std::map<std::uint32_t, std::int64_t> examined_;  // its points then
};

}  // namespace kintsugi::segmenter
