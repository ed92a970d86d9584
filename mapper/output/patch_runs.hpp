#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "lcmtypes/messages.hpp"
#include "mapper/core/slices/patch_run.hpp"

namespace kintsugi::mapper {

/// Of the frame P of a patch, by its number in the mapper.
using PoseOfPatch = std::function<PatchPose(int patch)>;

/// The patches of points that come one after the other; after the last of them, where they go.
class PatchRuns {
 public:
  void append(std::size_t num_points, const std::vector<PatchRun>& runs);
  /// Point number `number`, which comes after those of the calls before, moved from P to W.
  CloudPoint moved(std::int64_t number, const CloudPoint& point, const PoseOfPatch& pose_of);

 private:
  struct Run {
    std::int64_t end = 0;  ///< one past its last point
    int patch = kNoPatch;
  };

  std::vector<Run> runs_;
  std::size_t at_ = 0;             ///< the run of the last call
  std::optional<PatchPose> X_WP_;  ///< of that run, once it is needed
};

}  // namespace kintsugi::mapper
