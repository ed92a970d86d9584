#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "lcmtypes/geometry.hpp"
#include "lcmtypes/patch_pose.hpp"

namespace kintsugi::mapper {

/// How a correction moves what was seen at each keyframe: U is the uncorrected map, in which the
/// camera is tracked and the volume is, W the corrected one. And the part of the map to which that
/// belongs by now.
class MapDeformation {
 public:
  struct Place {
    Pose X_WU = Pose::Identity();
    int part = 0;  ///< see origin_of_part()
  };
  /// A loop that counts, and the part in which it is.
  struct PartLoop {
    int part = 0;
    LoopLink link;
  };

  /// Nothing is moved.
  MapDeformation() = default;

  /// @param number of the correction, from 1
  /// @param places by keyframe
  MapDeformation(int number, std::vector<Place> places, std::vector<PartLoop> loops = {})
      : number_(number), places_(std::move(places)), loops_(std::move(loops)) {}

  int number() const { return number_; }  ///< 0: nothing was corrected so far

  /// X_WU of what was seen at this keyframe; of one that is not known, that of the newest.
  Pose at(int keyframe) const { return place(keyframe).X_WU; }
  /// The part in which that is.
  int part_of(int keyframe) const { return place(keyframe).part; }
  Place place(int keyframe) const {
    if (places_.empty()) return {};
    return places_[std::min(static_cast<std::size_t>(keyframe), places_.size() - 1)];
  }

  /// Number of keyframes that are known.
  int size() const { return static_cast<int>(places_.size()); }

  const std::vector<PartLoop>& loops() const { return loops_; }

  /// Adds a keyframe, which is moved like this.
  void add(const Place& place) { places_.push_back(place); }

 private:
  int number_ = 0;
  std::vector<Place> places_;
  std::vector<PartLoop> loops_;
};

/// At which keyframe something was seen, and where that is by now.
struct SeenAt {
  int keyframe = 0;
  MapDeformation::Place place;
};

}  // namespace kintsugi::mapper
