#pragma once
// What has come, gone and moved between two maps of one place.

#include <cstdint>
#include <vector>

#include "lcmtypes/geometry.hpp"
#include "lcmtypes/messages.hpp"
#include "lcmtypes/object_messages.hpp"
#include "segmenter/views/observed_map.hpp"

namespace kintsugi::segmenter {

/// A thing that is in one map and not in the other, or elsewhere in the other. In AFTER's W.
struct MapChange {
  std::int32_t id = 0;  ///< from 1, largest first
  ChangeKind kind = ChangeKind::kNew;
  std::vector<CloudPoint> before;  ///< as it was; none: it was not there
  std::vector<CloudPoint> after;   ///< as it is; none: it is not there
  std::vector<std::uint32_t> before_segments;
  std::vector<std::uint32_t> after_segments;
  /// Of a thing that moved: maps its points before to where they are now.
  Pose X_after_before = Pose::Identity();
  double score = 0.0;  ///< 0 to 1: how sure it is

  /// What it is described by: as it is, else as it was.
  [[nodiscard]] const std::vector<CloudPoint>& points() const {
    return after.empty() ? before : after;
  }
};

struct MapChanges {
  std::vector<MapChange> changes;
  std::int64_t not_seen_again = 0;   ///< points of BEFORE of which AFTER tells nothing
  std::int64_t not_seen_before = 0;  ///< points of AFTER of which BEFORE tells nothing
};

/// Decided by free space and visibility: without views nothing is new or gone.
/// @param X_AB pose of BEFORE's W in AFTER's W
MapChanges find_changes(const ObservedMap& before, const ObservedMap& after, const Pose& X_AB);

}  // namespace kintsugi::segmenter
