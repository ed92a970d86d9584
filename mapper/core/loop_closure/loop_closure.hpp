#pragma once
// Loop closure of one run: from located frames to corrections.

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "mapper/core/loop_closure/camera_path.hpp"
#include "mapper/core/loop_closure/keyframe_tree.hpp"
#include "mapper/core/loop_closure/loop_closer.hpp"
#include "mapper/core/relocalization/keyframe_map.hpp"
#include "mapper/core/tracking/tracking_result.hpp"
#include "mapper/core/volume/tsdf_volume.hpp"

namespace kintsugi::mapper {

/// Follows the camera from keyframe to keyframe, and closes loops.
///
/// U is the uncorrected map, in which the camera is tracked and the volume is; W the corrected one.
class LoopClosure {
 public:
  struct Config {
    LoopCloser::Config closer;
    /// A correction costs receivers a run over all that moves. So one that moves nothing by more
    /// than a voxel waits until this long after the last one, s of device time; one that moves
    /// nothing by a tenth of a voxel is no correction.
    double period_s = 10.0;
    double large_motion_vox = 1.0;
    double least_motion_vox = 0.1;
    double reach_m = 5.0;  ///< how far a keyframe's surface is from it, m
    double voxel_m = 4.5 / 512;
    int max_similar = 6;  ///< keyframes that look alike, for each new one
    /// From a keyframe to its comparison with others, s of device time: three frames, in which a
    /// thread of its own computes its appearance.
    double appearance_s = 0.1;
    double max_speed = 2.0;  ///< m/s, of a camera that is lost, see Tracker

    /// @throws std::invalid_argument naming field, value and bound
    void validate() const;
  };

  /// `keyframes` outlives this object.
  /// @throws std::invalid_argument if the configuration is not valid
  LoopClosure(const Config& config, KeyframeMap& keyframes);

  /// The frames that follow are of another part of the map; all keyframes are released. Returns the
  /// number of the part.
  int begin_part();

  /// To be called before a located frame may become a keyframe: releases the keyframes whose
  /// surface is not in the volume any more, so that the camera gets a new one where it comes back
  /// to them.
  void release_left(const TsdfVolume& volume, const Pose& X_UC);

  /// To be called after it, when surface may have come back into the volume: the keyframes that see
  /// it count again.
  void take_back(const TsdfVolume& volume, const Pose& X_UC);

  /// By number: whether the camera, where it is, sees the surface of that keyframe where the
  /// keyframe saw it. Tracking does not drift on such a short way.
  std::vector<bool> near_keyframes() const { return keyframes_near(last_at_); }
  /// The same for a camera at another keyframe.
  std::vector<bool> keyframes_near(int keyframe) const {
    return tree_.within(keyframe, config_.reach_m);
  }

  /// By keyframe, length of the way on which tracking may have drifted between it and the one near
  /// which the camera is, or was: from one part to another over the loops that join them, and of
  /// all the camera's path, where none do.
  std::vector<double> ways_m() const;

  /// The nearest of the released keyframes that a camera at this pose is near, as corrected.
  std::optional<int> find_released_near(const Pose& X_WC) const;

  Pose X_WK(int keyframe) const { return deformation_.at(keyframe) * keyframes_[keyframe].X_WC; }

  /// The camera is now tracked at this keyframe, in surface that has come back; all others are
  /// released until take_back().
  void go_to(int keyframe);

  /// To be called before go_to(): the surface of this keyframe has found the camera, which is
  /// tracked at X_UC. Loops between the two places are from now on as measured here.
  void measure_anew(int keyframe, const TrackingResult& found, const Pose& X_UC,
                    std::int64_t utime);

  /// To be called after each located frame; `is_keyframe`: it has become the newest keyframe.
  void follow(const TrackingResult& located, bool is_keyframe, std::int64_t utime,
              const DepthNoise& noise);

  /// The newest keyframe that became one before this frame, once; nothing if there is none. To be
  /// called before each frame: waits for its appearance.
  std::optional<NewKeyframe> take_new();

  /// Whether a guest's keyframe may be added now: not while the next keyframe begins a part, nor
  /// while so many wait to be compared that those of the camera would not be in time.
  bool can_take_guest(std::size_t max_waiting) const;

  /// Adds a keyframe of a guest, another mapper, to be compared with all others. `guest.number` and
  /// what is found here (`similar`) are filled in; `guest.is_released` has the keyframes that are
  /// not in the guest's volume, and may be too short: those missing are not. A part begins where
  /// `guest.from` is empty. Returns its number.
  int add_guest(NewKeyframe guest, std::shared_ptr<Keyframe> keyframe, std::int64_t utime);

  /// The number that the next part will have.
  int next_part() const { return num_begun_; }

  /// A correction that is due at this time; waits for it.
  /// @throws what closing a loop threw
  std::optional<MapCorrection> take_due(std::int64_t utime);

  /// The end of the run: compares the last keyframe, too, and waits for all corrections.
  /// @throws as take_due()
  std::optional<MapCorrection> finish();

  /// By the corrections that were taken so far.
  const MapDeformation& deformation() const { return deformation_; }
  /// By part of the map.
  std::map<int, Trajectory> corrected_paths() const { return path_.corrected(deformation_); }

  /// The keyframe at which the camera is, or was last; at the beginning of a part the one that
  /// comes.
  int keyframe() const { return last_at_; }

  /// The part of the map in which the camera is.
  int part() const { return deformation_.part_of(last_at_); }
  /// How many parts of the map no loop has joined.
  int num_parts() const;

  int num_loops() const { return num_loops_; }                ///< that count
  int num_contradicted() const { return num_contradicted_; }  ///< that were given up

  double busy_ms() const { return closer_.busy_ms(); }

 private:
  void compare_newest();
  std::vector<int> similar_to(const NewKeyframe& added);
  std::optional<UnseenWay> unseen_way(std::int64_t utime) const;
  void note_near(int keyframe, const Pose& X_UC);
  std::optional<MapCorrection> apply_if_above(double least_motion_vox);
  void note(std::optional<MapCorrection> newest);
  double motion_m(const MapCorrection& correction) const;

  const Config config_;
  KeyframeMap& keyframes_;
  LoopCloser closer_;
  CameraPath path_;
  /// The newest keyframe, until it is compared with others.
  std::optional<NewKeyframe> newest_;
  std::int64_t newest_utime_ = 0;
  int newest_number_ = -1;       ///< of the camera's newest keyframe; those of guests may follow
  std::int64_t last_utime_ = 0;  ///< of the last located frame
  Eigen::Vector3d last_position_U_ = Eigen::Vector3d::Zero();  ///< of the camera, then
  std::int64_t lost_utime_ = 0;                                ///< last_utime_ when the part began
  double lost_at_m_ = 0.0;             ///< from the newest keyframe to where the camera was then
  std::optional<NewKeyframe> untold_;  ///< to be given by take_new()
  int last_at_ = 0;                    ///< the keyframe near which the camera is, or was
  double way_at_last_m_ = 0.0;         ///< from that keyframe to where it was near it last
  double length_at_last_m_ = 0.0;      ///< of the path, then
  MapDeformation deformation_;
  KeyframeTree tree_;
  bool went_ = false;         ///< go_to() was called since the last frame
  bool begins_part_ = false;  ///< with the next keyframe
  int num_begun_ = 0;         ///< parts
  int num_loops_ = 0;
  int num_contradicted_ = 0;
  std::optional<MapCorrection> waiting_;        ///< the newest, not applied yet
  std::int64_t applied_utime_ = INT64_MIN / 2;  ///< of the last one
};

}  // namespace kintsugi::mapper
