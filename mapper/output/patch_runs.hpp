#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <set>
#include <vector>

#include "lcmtypes/messages.hpp"
#include "lcmtypes/patch_motions.hpp"
#include "mapper/core/slices/patch_run.hpp"

namespace kintsugi::mapper {

/// Where a patch is, by its number in the mapper; nothing: its points count no more.
using PlaceOfPatch = std::function<std::optional<PatchPlace>(int patch)>;

/// The patches of points that come one after the other, numbered from 0; after the last of them,
/// where they go, and which of them are in a part of the map.
class PatchRuns {
 public:
  /// `runs`: the patches of the points; empty: they are of none, in part 0.
  void append(std::size_t num_points, const std::vector<PatchRun>& runs);

  /// After the last append(), before what follows. Without `place_of` nothing was moved.
  void place(const PlaceOfPatch& place_of);

  /// The parts of the map that the points are in.
  std::set<int> parts() const;

  /// Chooses the points that are kept: those in one part. All others are dropped.
  void select(int part);

  /// A point moved from P to W; nothing: it is dropped.
  std::optional<CloudPoint> moved(std::int64_t number, const CloudPoint& point) const;

  /// The number of a point among those that are not dropped; nothing: it is dropped.
  std::optional<std::int64_t> number_of_kept(std::int64_t number) const;

 private:
  struct Run {
    std::int64_t end = 0;  ///< one past its last point
    int patch = kNoPatch;
    int part = 0;                          ///< where it has no patch
    std::optional<PatchPlace> place = {};  ///< nothing: its points count no more
    bool is_kept = false;
    std::int64_t num_dropped = 0;  ///< points of runs before it
  };

  const Run& run_of(std::int64_t number) const;

  std::vector<Run> runs_;
};

}  // namespace kintsugi::mapper
