#pragma once
// The messages between the processes, as plain structs. codec/codec.hpp converts each to LCM
// messages and back, and checks the bounds of every field.

#include <cstdint>
#include <string>
#include <vector>

#include "lcmtypes/geometry.hpp"
#include "lcmtypes/object_messages.hpp"
#include "lcmtypes/patch_pose.hpp"
#include "lcmtypes/segment_messages.hpp"
#include "lcmtypes/statuses.hpp"
#include "lcmtypes/tracking_state.hpp"

namespace kintsugi {

/// Version of CloudPoint, PatchMotion, LoopLink and KeyframeFeature as packed records. Raise it
/// with every change of their layout: the order, type or meaning of a field. A receiver refuses
/// records of another version.
inline constexpr std::int16_t kCloudPointVersion = 1;

/// One surface point of the map in frame W; this is also its layout on the bus and in files
/// (32 bytes, little-endian, no padding).
struct CloudPoint {
  float x = 0.0F;  ///< metres, W
  float y = 0.0F;
  float z = 0.0F;
  float nx = 0.0F;  ///< unit normal, W, towards free space
  float ny = 0.0F;
  float nz = 0.0F;
  std::uint8_t red = 0;
  std::uint8_t green = 0;
  std::uint8_t blue = 0;
  std::uint8_t reserved = 0;  ///< zero
  float weight = 0.0F;        ///< number of observations fused, >= 0

  bool operator==(const CloudPoint&) const = default;
};
static_assert(sizeof(CloudPoint) == 32, "another layout: raise kCloudPointVersion");

/// Why a slice was sent: the direction in which the volume moved when it left, a change of its
/// tile of space, or the end of the run.
enum class SliceKind : std::int8_t {
  kFinal = 0,  ///< what was still in the volume at the end; the last slice of a session
  kShiftPlusX = 1,
  kShiftMinusX = 2,
  kShiftPlusY = 3,
  kShiftMinusY = 4,
  kShiftPlusZ = 5,
  kShiftMinusZ = 6,
  kPatch = 7,       ///< the surface in one tile of space, as it is at this moment
  kCorrection = 8,  ///< no surface, but new poses of patches
};

/// A piece of the map: the surface that left the moving volume at one moment, or a patch.
///
/// Slices of a session are numbered from 0 without gaps; kFinal is the last. A slice that is sent
/// again with a higher revision replaces the earlier one; not every revision is sent. A slice may
/// have no points.
///
/// A patch is sent while its surface is in the volume, and again when that has changed. Patches
/// that are sent together are a batch: they have the same `utime`, and the last one ends it.
///
/// The points of a patch are in a frame P of its own, which is W until the map is corrected. A
/// correction is a slice without points, with an id of its own like the others, that tells the new
/// poses X_WP of the patches that it moves; patches that it does not list stay where they are. The
/// poses are absolute: PatchMotions (patch_motions.hpp) has the rule which one counts.
struct CloudSlice {
  std::int64_t utime = 0;    ///< device time of the frame at which it left or was so, microseconds
  std::int64_t session = 0;  ///< one run of a mapper; > 0
  std::string map_name;      ///< distinguishes mappers on one bus
  /// Sequence number of its first chunk, and how many chunks it has. Set by the receiver, not by
  /// the sender; num_chunks is 0 when the slice was not received from a stream.
  std::int64_t sequence = 0;
  std::int32_t num_chunks = 0;
  std::int32_t id = 0;  ///< >= 0
  std::int32_t revision = 0;
  SliceKind kind = SliceKind::kFinal;
  bool in_volume = false;   ///< of a patch: it may still change
  bool ends_batch = false;  ///< the last patch of its batch, or a correction
  /// Of a patch: a newer revision followed while this one waited to be sent, so that its points
  /// were left out. Receivers ignore it.
  bool superseded = false;
  /// Of the final slice: the sum of the newest revisions of all slices of the session.
  std::int64_t revision_sum = 0;
  /// A run whose camera stays lost goes on in another part of the map. Until a loop joins them,
  /// nobody knows where two parts are relative to each other: they lie apart in W, farther than any
  /// map is large. This is the part in which the surface is by now; of a correction that in which
  /// its patches are after it. Joined parts have the number of the first of them.
  std::int32_t part = 0;
  float resolution_m = 0.0F;  ///< voxel size, > 0
  Pose X_WC = Pose::Identity();
  /// Of a patch: the pose of its frame P as of correction number `correction`. Of a correction:
  /// that of the mapper's odometry frame. Of other slices the identity.
  PatchPose X_WP;
  /// The number of corrections of the map so far that X_WP takes into account; of a correction its
  /// own number, from 1, ascending in the session.
  std::int32_t correction = 0;
  /// Of a patch: the number of the keyframe with which its surface moves when the map is corrected,
  /// for those whose map this one joins (KeyframeMessage); -1: it is of another mapper's camera.
  std::int32_t keyframe = 0;
  std::vector<CloudPoint> points_W;  ///< of a patch in P
  /// Of a correction: the patches that it moves, by ascending id. Of other slices none.
  std::vector<PatchMotion> motions;
  /// Of a correction: all loops of its part that count as of then. Of other slices none.
  std::vector<LoopLink> loops;
};

/// The pose of the depth camera at one frame.
struct CameraPose {
  std::int64_t utime = 0;  ///< device time of the frame, microseconds
  std::int64_t session = 0;
  std::int64_t frame_index = 0;
  TrackingState state = TrackingState::kStarting;
  Pose X_WC = Pose::Identity();
  std::int32_t part = 0;  ///< of the map, in which the camera is; see CloudSlice::part
};

/// One frame of the camera with compressed images.
struct RgbdFrameMessage {
  std::int64_t utime = 0;        ///< of the depth image, device time, microseconds
  std::int64_t color_utime = 0;  ///< of the colour image; equals utime when there is none
  std::int64_t session = 0;
  std::int64_t frame_index = 0;
  Intrinsics intrinsics;                 ///< of the depth image
  double depth_units_per_m = 1000;       ///< raw depth value / this = metres; raw 0 is invalid
  std::vector<std::uint8_t> depth_png;   ///< 16-bit single-channel PNG
  std::vector<std::uint8_t> color_jpeg;  ///< 8-bit three-channel JPEG or PNG, empty: no colour

  bool operator==(const RgbdFrameMessage&) const = default;
};

/// What the camera sees, at a small size: for those who look at the map beside it.
struct CameraView {
  std::int64_t utime = 0;    ///< of the frame, device time, microseconds
  std::int64_t session = 0;  ///< of the mapper
  std::string map_name;      ///< of the mapper
  std::int64_t frame_index = 0;
  TrackingState state = TrackingState::kStarting;
  Pose X_WC = Pose::Identity();  ///< when lost, the last known pose
  std::int32_t part = 0;         ///< as CameraPose::part
  Intrinsics intrinsics;         ///< of the camera's depth image, without distortion
  /// `depth_mm` has every depth_step-th pixel of the depth image along u and v: (i, j) is the pixel
  /// u = i * depth_step + depth_step / 2, v = j * depth_step + depth_step / 2, in integers.
  std::int32_t depth_step = 1;
  std::vector<std::uint16_t> depth_mm;   ///< along C's z, row after row; 0: not measured
  std::vector<std::uint8_t> color_jpeg;  ///< of the same view, of any size; empty: no colour

  std::int32_t depth_width() const { return intrinsics.width / depth_step; }    ///< pixels
  std::int32_t depth_height() const { return intrinsics.height / depth_step; }  ///< pixels
};

/// A corner of a keyframe's image, with an ORB descriptor; also its layout on the bus (44 bytes,
/// little-endian, no padding).
struct KeyframeFeature {
  float ray_x = 0.0F;    ///< x/z in K
  float ray_y = 0.0F;    ///< y/z
  float depth_m = 0.0F;  ///< along K's z; 0: not measured
  std::uint8_t descriptor[32] = {};

  bool operator==(const KeyframeFeature&) const = default;
};
static_assert(sizeof(KeyframeFeature) == 44, "another layout: raise kCloudPointVersion");

/// A keyframe of a mapper, for another one whose map it joins: what the camera saw there, and how
/// it got there. With all keyframes of a mapper, loops to them, and CloudSlice::keyframe, its map
/// can be put into the other one.
///
/// U is the uncorrected map, in which the camera was tracked. The points of a patch are in U, too:
/// P is U until a correction moves the patch.
struct KeyframeMessage {
  std::int64_t utime = 0;      ///< device time of its frame, microseconds
  std::int64_t session = 0;    ///< of the mapper
  std::string map_name;        ///< of the mapper
  std::string join;            ///< name of the map that it joins
  std::int32_t number = 0;     ///< in its map, ascending
  std::int32_t previous = -1;  ///< number of the keyframe sent before this one; -1: none was
  /// The keyframe from which the camera was tracked; -1: it begins a part of the map.
  std::int32_t tracked_from = -1;
  std::int32_t part = 0;  ///< of the map, in which the camera was tracked; see CloudSlice::part
  double way_m = 0.0;     ///< length of the camera's way from tracked_from to it
  /// How far the camera may have gone between the previous keyframe and the beginning of a part.
  double unseen_m = 0.0;
  float resolution_m = 0.0F;  ///< voxel size of the map, > 0
  Pose X_UK = Pose::Identity();
  /// Of its pose in the volume: of a small motion in K, translation (m) then rotation (rad).
  Eigen::Matrix<double, 6, 6> information_K = Eigen::Matrix<double, 6, 6>::Zero();
  /// Of the camera's depth z: its variance is base^2 + (share z)^2 + (growth z^2)^2.
  double noise_base_m = 0.0;
  double noise_share = 0.0;
  double noise_growth_per_m = 0.0;
  Intrinsics intrinsics;  ///< of the images, without distortion
  std::vector<std::int32_t>
      in_volume;  ///< earlier keyframes whose surface is in the volume; ascending
  std::vector<KeyframeFeature> features;  ///< none without colour
  /// Depth of the map's surface along K's z, quarters of a millimetre, row after row; 0: none.
  std::vector<std::uint16_t> depth;
  std::vector<std::uint8_t> intensity;  ///< the same pixels, 0 black .. 255 white; empty: no colour
};

/// A picture that the viewer has drawn.
struct Snapshot {
  std::int64_t utime = 0;  ///< wall clock, microseconds
  std::int64_t session = 0;
  std::string caption;     ///< what the picture shows
  std::int32_t width = 0;  ///< pixels
  std::int32_t height = 0;
  std::vector<std::uint8_t> image_jpeg;

  bool operator==(const Snapshot&) const = default;
};

/// The sender of a numbered stream tells which chunks exist.
struct Heartbeat {
  std::int64_t utime = 0;    ///< wall clock, microseconds
  std::int64_t session = 0;  ///< of the sender
  std::string channel;
  std::int64_t first_sequence = 0;  ///< the oldest that can still be resent
  std::int64_t next_sequence = 0;   ///< one past the newest
  /// The newest full state starts here: a receiver that has every chunk from here on needs no
  /// earlier one. 0: no full state was sent.
  std::int64_t state_sequence = 0;
  std::string map_name;  ///< of the map that the stream carries; empty: several maps

  bool operator==(const Heartbeat&) const = default;
};

/// Consecutive sequence numbers.
struct SequenceRange {
  std::int64_t first = 0;
  std::int64_t last = 0;  ///< inclusive

  bool operator==(const SequenceRange&) const = default;
};

/// A receiver of a numbered stream asks for chunks that it has not received.
struct ResendRequest {
  std::int64_t utime = 0;    ///< wall clock, microseconds
  std::int64_t session = 0;  ///< of the sender
  std::string channel;
  std::int64_t receiver = 0;  ///< number of the process that asks
  std::vector<SequenceRange> ranges;

  bool operator==(const ResendRequest&) const = default;
};

/// The sender of a numbered stream tells that it no longer has these chunks, and that nobody needs
/// them, because newer ones have replaced them: those of older revisions of patches.
struct ChunksReplaced {
  std::int64_t utime = 0;    ///< wall clock, microseconds
  std::int64_t session = 0;  ///< of the sender
  std::string channel;
  std::string map_name;               ///< of the map that the stream carries; empty: several maps
  std::vector<SequenceRange> ranges;  ///< at most kMaxResendRanges

  bool operator==(const ChunksReplaced&) const = default;
};

}  // namespace kintsugi
