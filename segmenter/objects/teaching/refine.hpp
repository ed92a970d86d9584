#pragma once
// Teaches an object again that is known.

#include "lcmtypes/geometry.hpp"
#include "segmenter/objects/library/known_object.hpp"
#include "segmenter/objects/recognition/agreement.hpp"

namespace kintsugi::segmenter {

/// How two observations of what may be one object lie upon each other.
struct ObservationFit {
  Pose X_OL = Pose::Identity();  ///< of the frame of the lesson in that of the known object
  LightChange light;             ///< what fell on the lesson, over what fell on the known object
  /// Share of the surface that is in both, of the smaller of the two: 0 to 1.
  double common = 0.0;
  /// Of the points whose normals both observations have, the share that is in both: sides that only
  /// one of them has seen do not count. 0 to 1.
  double agreement = 0.0;
  /// Enough of both for one object.
  [[nodiscard]] bool is_one_object() const;
};

/// The best fit, with both upright: z of an object with has_up is up, of others -y.
ObservationFit fit_observation(const ObjectModel& known, const ObjectModel& lesson);

struct Refinement {
  KnownObject object;
  ObservationFit fit;
  std::size_t num_added = 0;  ///< points of surface that was not known before
};

/// The known object with what the lesson adds: surface that both have is averaged, other surface is
/// added, in the light of the known object, also the views and lessons; times_taught are summed.
/// The parameters are those with which one of the two came out more whole.
/// @throws std::runtime_error naming the reason when they do not fit, or become too large
Refinement refined(const KnownObject& known, const KnownObject& lesson);

}  // namespace kintsugi::segmenter
