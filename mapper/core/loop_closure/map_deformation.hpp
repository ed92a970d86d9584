#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "lcmtypes/geometry.hpp"

namespace kintsugi::mapper {

/// How a correction moves what was seen at each keyframe: U is the uncorrected map, in which the
/// camera is tracked and the volume is, W the corrected one.
class MapDeformation {
 public:
  /// Nothing is moved.
  MapDeformation() = default;

  /// @param number of the correction, from 1
  /// @param X_WU by keyframe
  MapDeformation(int number, std::vector<Pose> X_WU) : number_(number), X_WU_(std::move(X_WU)) {}

  int number() const { return number_; }  ///< 0: nothing was corrected so far

  /// Of what was seen at this keyframe; of one that is not known, that of the newest.
  Pose at(int keyframe) const {
    if (X_WU_.empty()) return Pose::Identity();
    return X_WU_[std::min(static_cast<std::size_t>(keyframe), X_WU_.size() - 1)];
  }

  /// Of what was seen at the newest keyframe.
  Pose newest() const { return X_WU_.empty() ? Pose::Identity() : X_WU_.back(); }

  /// Adds a keyframe, which is moved like this.
  void add(const Pose& X_WU) { X_WU_.push_back(X_WU); }

 private:
  int number_ = 0;
  std::vector<Pose> X_WU_;
};

}  // namespace kintsugi::mapper
