#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "lcmtypes/messages.hpp"
#include "mapper/core/slices/patch_run.hpp"

namespace kintsugi::mapper {

/// Of the frame P of a patch, by its number in the mapper; nothing: its points count no more.
using PoseOfPatch = std::function<std::optional<PatchPose>(int patch)>;

/// The patches of points that come one after the other, numbered from 0; after the last of them,
/// where they go.
class PatchRuns {
 public:
  void append(std::size_t num_points, const std::vector<PatchRun>& runs);

  /// After the last append(), before what follows.
  void place(const PoseOfPatch& pose_of);

  /// A point moved from P to W; nothing: it is dropped.
  std::optional<CloudPoint> moved(std::int64_t number, const CloudPoint& point) const;

  /// The number of a point among those that are not dropped; nothing: it is dropped.
  std::optional<std::int64_t> number_of_kept(std::int64_t number) const;

 private:
  struct Run {
    std::int64_t end = 0;  ///< one past its last point
    int patch = kNoPatch;
    std::optional<PatchPose> X_WP;  ///< nothing: dropped
    std::int64_t num_dropped = 0;   ///< points of runs before it
  };

  const Run& run_of(std::int64_t number) const;

  std::vector<Run> runs_;
};

}  // namespace kintsugi::mapper
