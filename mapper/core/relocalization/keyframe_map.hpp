#pragma once
// Places the camera has been to, to be known again.

#include <cstdint>
#include <future>
#include <vector>

#include <opencv2/core.hpp>

#include "mapper/core/frame/surface_map.hpp"
#include "mapper/core/relocalization/descriptor_index.hpp"
#include "mapper/core/relocalization/place_view.hpp"

namespace kintsugi::mapper {

/// A keyframe: where the camera was, what it looked like there, and the map's surface as seen from
/// there, kept for when the volume has moved on.
struct Place {
  Pose X_WC = Pose::Identity();
  PlaceView view;
  Intrinsics camera;                  ///< of the surface: a small image, 160x120 of 640x480
  cv::Mat_<std::uint16_t> depth_raw;  ///< in quarters of a millimetre; 0 is invalid

  /// Depth and normals again.
  SurfaceMap surface() const;
};

/// Keyframes, spread over the space that was seen: memory grows with that, not with time. One of
/// 500 features takes 38 kB of depth, 19 kB of intensities, 22 kB of features and 24 kB of index.
///
/// What a keyframe looks like is worked out on a thread of its own and waited for by whatever needs
/// it: what the functions return does not depend on how long that takes.
class KeyframeMap {
 public:
  struct Config {
    double spacing_m = 0.15;  ///< a pose further than this from every keyframe, or turned more than
    double spacing_rad = 0.17;  ///< this (10 degrees) from those nearer, becomes a keyframe
    int max_features = 500;     ///< of a keyframe
    int max_by_features = 4;    ///< candidates that share features with a view
    int min_shared_features = 10;
    int max_by_depth = 8;  ///< candidates whose depth thumbnail is like the view's

    /// @throws std::invalid_argument naming field, value and bound
    void validate() const;
  };

  /// @throws std::invalid_argument if the configuration is not valid
  explicit KeyframeMap(const Config& config);

  /// Is no keyframe near this pose?
  bool is_due(const Pose& X_WC) const;

  /// A new keyframe: the frame at X_WC, and the map's surface as seen from there.
  void add(const Pose& X_WC, const TrackingInput& frame, const SurfaceMap& surface_C);

  /// Numbers of the keyframes most like a view, none twice: by features in common, most first, then
  /// by depth, most similar first.
  std::vector<int> similar_to(const PlaceView& view);

  int size() const { return static_cast<int>(keyframes_.size()); }
  /// @pre similar_to() was called since the last add().
  const Place& operator[](int number) const { return keyframes_[number]; }

 private:
  void finish_last();
  std::vector<int> by_features(const PlaceView& view) const;
  std::vector<int> by_depth(const PlaceView& view) const;

  Config config_;
  std::vector<Place> keyframes_;
  DescriptorIndex index_;
  std::future<PlaceView> view_of_last_;  ///< valid while the last keyframe's view is not there yet
};

}  // namespace kintsugi::mapper
