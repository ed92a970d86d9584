#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "viewer/core/map/map_slice.hpp"

namespace kintsugi::viewer {

/// The revisions of one slice that are of use: the one that is shown, and newer ones that have no
/// labels yet. Surface that has its segments keeps them in sight that way, until those of the newer
/// revision are here.
class SliceRevisions {
 public:
  explicit SliceRevisions(MapSlice first) : shown_(std::move(first)) {}

  const MapSlice& shown() const { return shown_; }
  MapSlice& newest() { return waiting_.empty() ? shown_ : waiting_.back(); }
  const MapSlice& newest() const { return waiting_.empty() ? shown_ : waiting_.back(); }
  MapSlice* find(std::int32_t revision);  ///< nullptr: not here

  /// Adds a revision that is newer than the newest.
  void add(MapSlice newer);

  /// Shows the newest revision that has labels; the newest of all if the one that is shown has
  /// none. Returns the one that was shown before, if it is another.
  std::optional<MapSlice> advance();
  /// Shows the newest revision, with or without labels. Returns as advance().
  std::optional<MapSlice> advance_to_newest();

  /// Calls function(MapSlice&) for every revision.
  template <class Function>
  void for_each(Function&& function) {
    function(shown_);
    for (MapSlice& slice : waiting_) function(slice);
  }

 private:
  /// A segmenter is at most so many revisions behind, or the oldest of them is not waited for.
  static constexpr std::size_t kMaxWaiting = 4;

  std::optional<MapSlice> show(std::size_t waiting);

  MapSlice shown_;
  std::vector<MapSlice> waiting_;  // by ascending revision, all newer than shown_
};

}  // namespace kintsugi::viewer
