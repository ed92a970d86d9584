#pragma once
// From depth and colour frames to the camera's path and the slices of the map.
//
// Frames: W map (the camera at the first frame, or that of the given poses; of later parts see
// origin_of_part()), C depth camera.

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "lcmtypes/messages.hpp"
#include "lcmtypes/trajectory.hpp"
#include "mapper/core/frame/local_noise.hpp"
#include "mapper/core/frame/rgbd_frame.hpp"
#include "mapper/core/fusion/integrator.hpp"
#include "mapper/core/fusion/raycaster.hpp"
#include "mapper/core/guests/guests.hpp"
#include "mapper/core/local_map/local_map.hpp"
#include "mapper/core/loop_closure/loop_closure.hpp"
#include "mapper/core/loop_closure/map_part.hpp"
#include "mapper/core/relocalization/relocalizer.hpp"
#include "mapper/core/stage_times.hpp"
#include "mapper/core/tracking/noise_estimator.hpp"
#include "mapper/core/tracking/restart_rule.hpp"
#include "mapper/core/tracking/tracker.hpp"

namespace kintsugi::mapper {

/// With a frame another part of the map begins.
struct PartBegun {
  int part = 0;
  TrackingResult lost;  ///< what became of the frame in the part before
};

/// The result of one frame.
struct FrameResult {
  TrackingResult tracking;
  int part = 0;           ///< of the map, in which the camera is
  bool is_fused = false;  ///< into the map
  std::optional<PartBegun> part_begun;
  std::vector<CloudSlice>
      slices;  ///< finished since the frame before; they left at any earlier frame
  std::optional<MapCorrection> correction;  ///< loops were closed
  int slices_left = 0;                      ///< slices that left the volume at this frame
  StageTimes times;                         ///< wall time
  StageTimes cpu_times;                     ///< CPU time of the whole process during these stages
};

/// Tracks the camera, fuses each frame into a volume that moves with it, and returns what leaves
/// the volume as slices, numbered from 0 without gaps.
///
/// The same frames give the same poses and the same slices, bit by bit, whatever the number of
/// threads; only the frame at which a finished slice is returned depends on timing. `session` and
/// `map_name` of the slices are set by the publisher.
///
///     Starting --first frame with a surface in the cube--> Tracking
///     Tracking --the loss rule rejects the pose--> Lost
///     Lost     --found near the last pose (Tracker), or by a keyframe (Relocalizer)--> Tracking
///     Lost     --for so long that RestartRule is due--> Starting, another part of the map
///
/// A part begins only with a frame in whose surface a camera can be tracked: one that stands before
/// a bare wall for hours would begin thousands of them.
///
/// Only frames whose pose is known are fused, and not all of them where the caller is in a hurry. A
/// lost frame leaves map and last pose unchanged. When the camera is found elsewhere, the cube
/// moves there, and the blocks that leave it become slices. With given poses there is no Starting
/// and no Tracking: each frame is Given, or Lost.
class MapperPipeline {
 public:
  struct Config : LocalMap::Config {
    Integrator::Config integrator;
    Raycaster::Config raycaster;
    Tracker::Config tracker;
    Relocalizer::Config relocalizer;
    LoopClosure::Config loops;  ///< but for what follows from the rest, see loop_closure()
    /// The map is corrected where the camera comes back to a place. For patches, and without a
    /// given path.
    bool close_loops = true;
    std::optional<DepthNoise> noise;  ///< of the camera's depth; none: typical_noise()
    bool learn_noise = true;          ///< `noise` is only where the estimate starts
    /// Depth farther than where the noise asks for the largest truncation distance is not used.
    bool limit_range_by_noise = false;
    /// A camera that is lost for so long begins another part of the map; 0: never. Not with a given
    /// path, where a lost frame is one without a pose.
    double restart_after_s = 5.0;
    int finest_tracking_width_px = 320;  ///< images are halved while at least this remains
    Trajectory given_path;  ///< if not empty, replaces tracking; a frame without a pose is lost

    /// Makes volume, fusion and raycast as large as depth up to `max_range_m` asks for; 0: as the
    /// noise allows, within what the volume and images of 16 bits can hold. For a ball.
    void set_max_range(double max_range_m);

    bool closes_loops() const { return close_loops && patch_side_m > 0.0 && given_path.empty(); }
    /// `loops` with the lengths in voxels, the reach, the drift and the speed of the rest.
    LoopClosure::Config loop_closure() const;

    /// @throws std::invalid_argument naming field, value and bound
    void validate() const;
  };

  /// @throws std::invalid_argument if the configuration is not valid
  explicit MapperPipeline(const Config& config);

  /// Frames must be in order of time and have the same intrinsics.
  /// @param fuse false: the frame is only tracked, in two thirds of the time. It is fused
  /// nevertheless where tracking goes on with it: the first one, one that a keyframe has found, and
  /// with a given path
  /// @throws std::invalid_argument if the sizes of an image and of the intrinsics differ; the map
  /// and the pose are unchanged then
  FrameResult process(const RgbdFrame& measured, bool fuse = true);

  /// The newest keyframe, once, for the mapper whose map this one joins; nothing if there is none
  /// since the last call. To be called before each frame and before finish().
  std::optional<KeyframeMessage> take_keyframe();

  /// Takes what guests have sent, other mappers that join this map; it is put into the map after
  /// the next frames. Then slices and corrections depend on when it came. Does nothing where loops
  /// are not closed.
  void add_guest(KeyframeMessage keyframe) { guests_.add(std::move(keyframe)); }
  void add_guest(CloudSlice slice) { guests_.add(std::move(slice)); }
  const Guests& guests() const { return guests_; }

  /// Ends the run: waits for the slices that are being extracted and returns them; the last one is
  /// the final slice, with all that is still in the volume. process() must not be called
  /// afterwards.
  std::vector<CloudSlice> finish();

  std::int64_t num_blocks() const { return static_cast<std::int64_t>(map_.volume().num_blocks()); }
  int num_keyframes() const { return relocalizer_.num_keyframes(); }
  /// None where loops are not closed.
  const LoopClosure* loops() const { return loops_.get(); }
  /// Where a patch is in the corrected map, by its number in PatchRun; nothing: its points were
  /// replaced. After finish().
  std::optional<PatchPlace> place_of_patch(int patch) const { return map_.place_of_patch(patch); }

  /// How many parts of the map no loop has joined.
  int num_parts() const { return loops_ ? loops_->num_parts() : map_.part() + 1; }
  /// How many have begun, those of guests included.
  int num_parts_begun() const { return loops_ ? loops_->next_part() : map_.part() + 1; }

  /// Of the frames whose pose is known, as corrected by the loops that were closed so far; by part
  /// of the map.
  std::map<int, Trajectory> corrected_paths() const;
  std::int64_t volume_bytes() const {
    return static_cast<std::int64_t>(map_.volume().memory_bytes());
  }
  const DepthNoise& noise() const { return noise_.noise(); }
  /// Of what has left and may come back.
  std::int64_t kept_bytes() const { return static_cast<std::int64_t>(map_.kept_bytes()); }
  double extraction_ms() const { return map_.extraction_ms(); }

 private:
  /// The frame without depths that are no surface.
  RgbdFrame cleaned(const RgbdFrame& frame);
  TrackingInput prepare(const RgbdFrame& frame) const;
  TrackingResult locate(const TrackingInput& input);
  TrackingResult locate_on_given_path(std::int64_t utime) const;
  TrackingResult start(const TrackingInput& input);
  void learn_noise(const TrackingInput& input, const Pose& X_WC);
  bool can_be_tracked_in(const TrackingInput& input) const;
  PartBegun begin_part(TrackingResult lost);
  std::optional<MapCorrection> correct(std::optional<MapCorrection> correction);
  std::optional<TrackingResult> find_again(const TrackingInput& input);
  /// Moves the volume with the camera, fuses the frame and makes the model for the next one.
  void fuse_into_map(const RgbdFrame& frame, const TrackingInput& input, FrameResult& result,
                     StageClock& clock);
  void follow(const TrackingResult& located, bool is_keyframe, std::int64_t utime);
  void move_to(const TrackingResult& located, const TrackingInput& input);
  void update_model(const RgbdFrame& frame, const TrackingInput& input, TrackingResult& located);
  bool go_over_to_known_surface(const TrackingInput& input);
  void go_over_to(int keyframe, const Pose& X_NC, const TrackingInput& input);
  /// After a lost frame: the model for the next one is the map as seen from where the camera should
  /// be.
  void look_where_expected(const TrackingInput& input);
  /// The map's surface as seen from a pose; the guide is that of Raycaster::raycast().
  Model model_from(const Pose& X_WV, const Intrinsics& camera,
                   const cv::Mat_<float>& guide_depth_m) const;
  int halvings(const Intrinsics& intrinsics) const;

  StampedPose camera() const { return {utime_, X_WC_}; }

  Config config_;
  Integrator integrator_;
  Raycaster raycaster_;
  Tracker tracker_;
  NoiseEstimator noise_;
  LocalNoiseEstimator local_noise_;
  Relocalizer relocalizer_;
  std::unique_ptr<LoopClosure> loops_;  ///< none: the map is not corrected
  Guests guests_;
  std::optional<int> told_keyframe_;  ///< the last one that take_keyframe() gave
  RestartRule restart_rule_;
  std::map<int, Trajectory> paths_;  ///< by part, where loops are not closed
  LocalMap map_;
  std::optional<Model> model_;     ///< none before the first fused frame of a part
  Pose X_WC_ = origin_of_part(0);  ///< of the last fused frame, as tracked; W is U here
  bool has_frames_ = false;
  std::int64_t utime_ = 0;  ///< of the last frame
};

}  // namespace kintsugi::mapper
