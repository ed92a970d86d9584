#pragma once
// When the camera has seen a point of surface often enough.

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "lcmtypes/messages.hpp"

namespace kintsugi::segmenter {

/// Surface is in the mapper's map once it was observed in some frames. Of these the log has only
/// some views: a point that is in sight in two views one after the other was so in the frames
/// between them, too. In sight: the camera measures about the distance of the point where it is in
/// its image.
class SurfaceSights {
 public:
  /// @param radius_m between the point and what is measured there, along the ray, > 0
  /// @param min_frames in which a point must be in sight
  SurfaceSights(double radius_m, std::int64_t min_frames)
      : radius_m_(radius_m), min_frames_(min_frames) {}

  /// A view whose pose is known, later than those before. @param now_s wall clock
  void add(const CameraView& view, double now_s);

  /// The wall clock of the first view by which the point was in sight in enough frames.
  std::optional<double> seen_s(const Eigen::Vector3d& p_W) const;

 private:
  struct View {
    CameraView view;  ///< without the colours
    double time_s = 0.0;
  };
  bool is_in_sight(const CameraView& view, const Eigen::Vector3d& p_W) const;

  double radius_m_;
  std::int64_t min_frames_;
  std::vector<View> views_;
};

}  // namespace kintsugi::segmenter
