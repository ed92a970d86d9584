#pragma once
// The messages between the processes, as plain structs. codec/codec.hpp converts each to LCM
// messages and back, and checks the bounds of every field.

#include <cstdint>
#include <string>
#include <vector>

#include "lcmtypes/geometry.hpp"
#include "lcmtypes/segment_messages.hpp"
#include "lcmtypes/statuses.hpp"
#include "lcmtypes/tracking_state.hpp"

namespace kintsugi {

/// Version of CloudPoint as a packed record. Raise it with every change of its layout: the order,
/// type or meaning of a field. A receiver refuses points of another version.
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

/// Why a slice left the volume: the direction in which the volume moved, or the end of the run.
enum class SliceKind : std::int8_t {
  kFinal = 0,  ///< what was still in the volume at the end; the last slice of a session
  kShiftPlusX = 1,
  kShiftMinusX = 2,
  kShiftPlusY = 3,
  kShiftMinusY = 4,
  kShiftPlusZ = 5,
  kShiftMinusZ = 6,
};

/// A piece of the map: the surface that left the moving volume at one moment.
///
/// Slices of a session are numbered from 0 without gaps; kFinal is the last. A slice that is sent
/// again with a higher revision replaces the earlier one. A slice may have no points.
struct CloudSlice {
  std::int64_t utime = 0;    ///< device time of the frame at which it left, microseconds
  std::int64_t session = 0;  ///< one part of one run of a mapper; > 0
  std::string map_name;      ///< distinguishes mappers on one bus
  /// Sequence number of its first chunk, and how many chunks it has. Set by the receiver, not by
  /// the sender; num_chunks is 0 when the slice was not received from a stream.
  std::int64_t sequence = 0;
  std::int32_t num_chunks = 0;
  std::int32_t id = 0;  ///< >= 0
  std::int32_t revision = 0;
  SliceKind kind = SliceKind::kFinal;
  /// A run whose camera stays lost goes on in another part: a map of its own, in a frame W of its
  /// own, in the session with the next number. So session - part is the session of part 0.
  std::int32_t part = 0;      ///< from 0, < session
  bool part_follows = false;  ///< of the final slice: the run goes on with another part
  float resolution_m = 0.0F;  ///< voxel size, > 0
  Pose X_WC = Pose::Identity();
  std::vector<CloudPoint> points_W;
};

/// The pose of the depth camera at one frame.
struct CameraPose {
  std::int64_t utime = 0;  ///< device time of the frame, microseconds
  std::int64_t session = 0;
  std::int64_t frame_index = 0;
  TrackingState state = TrackingState::kStarting;
  Pose X_WC = Pose::Identity();
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

}  // namespace kintsugi
