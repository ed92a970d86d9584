#pragma once

#include "lcmtypes/geometry.hpp"
#include "segmenter/objects/recognition/agreement.hpp"

namespace kintsugi::segmenter {

/// Where an object may be.
struct PoseHypothesis {
  Pose X_WO = Pose::Identity();
  LightChange light;
  /// Share of the points seen that agree with the model's surface.
  float agreement = 0.0F;
};

}  // namespace kintsugi::segmenter
