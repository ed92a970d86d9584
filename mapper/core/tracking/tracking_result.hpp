#pragma once

#include <optional>

#include "lcmtypes/geometry.hpp"
#include "lcmtypes/messages.hpp"
#include "mapper/core/registration/registration_quality.hpp"
#include "mapper/core/registration/twist.hpp"
#include "mapper/core/tracking/loss_rule.hpp"

namespace kintsugi::mapper {

struct TrackingResult {
  TrackingState state = TrackingState::kStarting;
  Pose X_WC = Pose::Identity();  ///< the last good pose when state is kLost
  RegistrationQuality quality;
  int iterations = 0;
  std::optional<LossReason> loss_reason;        ///< set when state is kLost
  std::optional<LossReason> first_loss_reason;  ///< why the pose that continues the motion was
                                                ///< rejected, if it was
  /// After a loss: the number of the keyframe that was compared, if X_WC is in the frame in which
  /// that was tracked.
  std::optional<int> found_by_keyframe;
  /// See Registration; zero where there was none.
  Matrix6d information_C = Matrix6d::Zero();
  TwistBasis open_to_depth_C;  ///< directions of motion that depth does not determine
  TwistBasis undetermined_C;   ///< of these, the ones that colour leaves open; any: state is kLost
};

}  // namespace kintsugi::mapper
