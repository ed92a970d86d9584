#pragma once
// The keyframes of relocalisation, and the search for those that look like a frame.

#include <cstdint>
#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <vector>

#include <opencv2/core.hpp>

#include "mapper/core/frame/surface_map.hpp"
#include "mapper/core/relocalization/descriptor_index.hpp"
#include "mapper/core/relocalization/keyframe_appearance.hpp"

namespace kintsugi::mapper {

/// A pose of the camera, what the frame looked like, and the map's surface as seen from there,
/// which is needed when the volume no longer covers it.
struct Keyframe {
  Pose X_WC = Pose::Identity();
  KeyframeAppearance appearance;
  Intrinsics camera;                  ///< of the surface: 160x120 where frames are 640x480
  cv::Mat_<std::uint16_t> depth_raw;  ///< in quarters of a millimetre; 0 is invalid

  /// Of a pixel, along the camera's z, metres; 0 where it is invalid.
  double depth_m(int v, int u) const { return depth_raw(v, u) / kRawPerMetre; }
  /// The point of a pixel in K, metres; the origin where it is invalid.
  Eigen::Vector3d point(int v, int u) const {
    return depth_m(v, u) *
           Eigen::Vector3d((u - camera.cx) / camera.fx, (v - camera.cy) / camera.fy, 1.0);
  }
  /// Depth, and the normals computed from it.
  SurfaceMap surface() const;

  static constexpr double kRawPerMetre = 4000.0;  ///< of depth_raw
};

/// Keyframes at a minimum spacing, so that memory grows with the space that was seen and not with
/// time. A keyframe of 500 features takes 38 kB of depth, 19 kB of intensities, 22 kB of features
/// and 24 kB of index.
///
/// The appearance of a keyframe is computed on a thread of its own. Functions that need it wait for
/// it, so that their results do not depend on timing.
class KeyframeMap {
 public:
  struct Config {
    /// A pose becomes a keyframe if no keyframe is within both of these.
    double spacing_m = 0.15;
    double spacing_rad = 0.17;     ///< 10 degrees
    int max_features = 500;        ///< of a keyframe
    int max_by_features = 4;       ///< candidates that share features with a frame
    int min_shared_features = 10;  ///< of a candidate with the frame
    int max_by_depth = 8;          ///< candidates with a similar depth thumbnail

    /// @throws std::invalid_argument naming field, value and bound
    void validate() const;
  };

  /// @throws std::invalid_argument if the configuration is not valid
  explicit KeyframeMap(const Config& config);

  /// The nearest to this pose of the keyframes that are within the spacing and were not released;
  /// nothing: a keyframe is due.
  std::optional<int> find_near(const Pose& X_WC) const;

  /// The distance of two poses or the angle between them, in units of the spacing, whichever is
  /// larger.
  double in_spacings(const Pose& X_WA, const Pose& X_WB) const;

  /// Adds the frame at X_WC as a keyframe, with the map's surface as seen from there.
  void add(const Pose& X_WC, const TrackingInput& frame, const SurfaceMap& surface_C);

  /// Adds a keyframe of a guest, another mapper: the camera is not looked for there, and its
  /// surface is never in the volume.
  void add_guest(std::shared_ptr<Keyframe> keyframe);

  /// Releases the keyframes of which this is true. A pose near them may become a keyframe again:
  /// their surface is in the volume no more, so a new one says where the camera is now.
  void release_if(const std::function<bool(const Keyframe&)>& has_left);
  void release(int number) { is_released_[number] = true; }
  /// The surface of a released keyframe is in the volume again.
  void take_back(int number) { is_released_[number] = false; }
  const std::vector<bool>& is_released() const { return is_released_; }  ///< by number
  bool is_guest(int number) const { return is_guest_[number]; }

  /// Numbers of the most similar keyframes, without duplicates: first by the number of shared
  /// features, most first, then by depth thumbnail, most similar first: of those for which
  /// `is_near` is true. Not those of guests.
  std::vector<int> similar_to(const KeyframeAppearance& appearance,
                              const std::function<bool(int)>& is_near);

  /// The same for keyframe `number`, of all for which `is_candidate` is true.
  std::vector<int> similar_to(int number, const std::function<bool(int)>& is_candidate);

  /// Waits for the appearance of the last keyframe.
  void finish_last();

  int size() const { return static_cast<int>(keyframes_.size()); }
  /// @pre similar_to() or finish_last() was called since the last add().
  const Keyframe& operator[](int number) const { return *keyframes_[number]; }
  /// The same, for other threads.
  std::shared_ptr<const Keyframe> share(int number) const { return keyframes_[number]; }

 private:
  std::vector<int> by_features(const KeyframeAppearance& appearance,
                               const std::function<bool(int)>& is_candidate) const;
  std::vector<int> by_depth(const KeyframeAppearance& appearance,
                            const std::function<bool(int)>& is_candidate) const;

  Config config_;
  std::vector<std::shared_ptr<Keyframe>> keyframes_;
  std::vector<bool> is_released_;
  std::vector<bool> is_guest_;
  DescriptorIndex index_;
  /// Of the last keyframe; valid until it is stored there.
  std::future<KeyframeAppearance> appearance_of_last_;
};

}  // namespace kintsugi::mapper
