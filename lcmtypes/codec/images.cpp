// The messages that carry compressed images.

#include <algorithm>

#include <kintsugi/camera_view_t.hpp>
#include <kintsugi/rgbd_frame_t.hpp>
#include <kintsugi/snapshot_t.hpp>

#include "lcmtypes/codec/bulk.hpp"
#include "lcmtypes/codec/intrinsics.hpp"

namespace kintsugi {
namespace codec {

/// Other people's drivers publish frames, too.
template <>
inline constexpr bool kChecksumOptional<rgbd_frame_t> = true;

template <>
struct Bulk<RgbdFrameMessage> : PlacedByByte<rgbd_frame_t> {
  static constexpr int kNumStrings = 0;

  template <class From, class To>
  static void copy(const From& from, To& to) {
    to.utime = from.utime;
    to.color_utime = from.color_utime;
    to.session = from.session;
    to.frame_index = from.frame_index;
    to.depth_units_per_m = from.depth_units_per_m;
  }
  static void header_to_wire(const RgbdFrameMessage& frame, rgbd_frame_t& wire) {
    copy(frame, wire);
    copy_intrinsics(frame.intrinsics, wire);
    std::ranges::copy(frame.intrinsics.distortion, wire.distortion);
  }
  static void header_from_wire(const rgbd_frame_t& wire, RgbdFrameMessage& frame) {
    copy(wire, frame);
    copy_intrinsics(wire, frame.intrinsics);
    std::ranges::copy(wire.distortion, frame.intrinsics.distortion.begin());
  }
  static void set_counts(rgbd_frame_t& wire, const Counts& counts) {
    wire.depth_bytes = counts[0];
    wire.color_bytes = counts[1];
  }
  static Counts counts(const rgbd_frame_t& wire) {
    return {wire.depth_bytes, wire.color_bytes, 0, 0};
  }

  static void check_header(const Check& check, const RgbdFrameMessage& frame,
                           const Counts& counts) {
    check.not_negative("utime", frame.utime);
    check.not_negative("color_utime", frame.color_utime);
    check.positive("session", frame.session);
    check.not_negative("frame_index", frame.frame_index);
    check.range("depth_units_per_m", frame.depth_units_per_m, 1.0, 1e6);
    check.positive("depth_bytes", counts[0]);
    check_intrinsics(check, frame.intrinsics);
  }
  /// The images are checked where they are decompressed.
  static void check_records(const Check& /*check*/, const RgbdFrameMessage& /*frame*/) {}

  template <class Frame, class Function>
  static void for_each_vector(Frame& frame, const Function& function) {
    function(frame.depth_png);
    function(frame.color_jpeg);
  }
};

static_assert(camera_view_t::STATE_STARTING == static_cast<int>(TrackingState::kStarting));
static_assert(camera_view_t::STATE_TRACKING == static_cast<int>(TrackingState::kTracking));
static_assert(camera_view_t::STATE_LOST == static_cast<int>(TrackingState::kLost));
static_assert(camera_view_t::STATE_GIVEN == static_cast<int>(TrackingState::kGiven));

template <>
struct Bulk<CameraView> : PlacedByByte<camera_view_t> {
  static constexpr int kNumStrings = 1;

  template <class From, class To>
  static void copy(const From& from, To& to) {
    to.utime = from.utime;
    to.session = from.session;
    to.map_name = from.map_name;
    to.frame_index = from.frame_index;
    to.state = static_cast<decltype(to.state)>(from.state);
    to.part = from.part;
    to.depth_step = from.depth_step;
  }
  static void header_to_wire(const CameraView& view, camera_view_t& wire) {
    copy(view, wire);
    copy_intrinsics(view.intrinsics, wire);
    pose_to_wire(view.X_WC, wire.X_WC);
  }
  static void header_from_wire(const camera_view_t& wire, CameraView& view) {
    copy(wire, view);
    copy_intrinsics(wire, view.intrinsics);
    view.X_WC = pose_from_wire(wire.X_WC);
  }
  static void set_counts(camera_view_t& wire, const Counts& counts) {
    wire.num_depths = counts[0];
    wire.color_bytes = counts[1];
  }
  static Counts counts(const camera_view_t& wire) {
    return {wire.num_depths, wire.color_bytes, 0, 0};
  }

  static void check_header(const Check& check, const CameraView& view, const Counts& counts) {
    check.not_negative("utime", view.utime);
    check.positive("session", view.session);
    check.text("map_name", view.map_name);
    check.not_negative("frame_index", view.frame_index);
    check_state(check, view.state);
    check.not_negative("part", view.part);
    check.pose("X_WC", view.X_WC);
    check_intrinsics(check, view.intrinsics);
    check.range("depth_step", view.depth_step, 1,
                std::min(view.intrinsics.width, view.intrinsics.height));
    const int num_depths = view.depth_width() * view.depth_height();
    check.range("num_depths", counts[0], num_depths, num_depths);
  }
  /// The colour image is checked where it is decompressed.
  static void check_records(const Check& check, const CameraView& view) {
    for (const double coefficient : view.intrinsics.distortion) {
      check.range("distortion", coefficient, 0.0, 0.0);
    }
  }

  template <class View, class Function>
  static void for_each_vector(View& view, const Function& function) {
    function(view.depth_mm);
    function(view.color_jpeg);
  }
};

template <>
struct Bulk<Snapshot> : PlacedByByte<snapshot_t> {
  static constexpr int kNumStrings = 1;

  template <class From, class To>
  static void copy(const From& from, To& to) {
    to.utime = from.utime;
    to.session = from.session;
    to.caption = from.caption;
    to.width = from.width;
    to.height = from.height;
  }
  static void header_to_wire(const Snapshot& snapshot, snapshot_t& wire) { copy(snapshot, wire); }
  static void header_from_wire(const snapshot_t& wire, Snapshot& snapshot) { copy(wire, snapshot); }
  static void set_counts(snapshot_t& wire, const Counts& counts) { wire.image_bytes = counts[0]; }
  static Counts counts(const snapshot_t& wire) { return {wire.image_bytes, 0, 0, 0}; }

  static void check_header(const Check& check, const Snapshot& snapshot, const Counts& counts) {
    check.not_negative("utime", snapshot.utime);
    check.positive("session", snapshot.session);
    check.range("width", snapshot.width, 1, kMaxImageSide_px);
    check.range("height", snapshot.height, 1, kMaxImageSide_px);
    check.positive("image_bytes", counts[0]);
    check.text("caption", snapshot.caption);
  }
  static void check_records(const Check& /*check*/, const Snapshot& /*snapshot*/) {}

  template <class Picture, class Function>
  static void for_each_vector(Picture& snapshot, const Function& function) {
    function(snapshot.image_jpeg);
  }
};

}  // namespace codec

template std::int64_t payload_bytes(const RgbdFrameMessage&);
template std::int32_t num_chunks(const RgbdFrameMessage&, std::size_t);
template Bytes encode_chunk(const RgbdFrameMessage&, std::int64_t, std::int32_t, std::size_t);
template Chunk<RgbdFrameMessage> decode_chunk(ByteView);
template RgbdFrameMessage join(const std::vector<Chunk<RgbdFrameMessage>>&);

template std::int64_t payload_bytes(const CameraView&);
template std::int32_t num_chunks(const CameraView&, std::size_t);
template Bytes encode_chunk(const CameraView&, std::int64_t, std::int32_t, std::size_t);
template Chunk<CameraView> decode_chunk(ByteView);
template CameraView join(const std::vector<Chunk<CameraView>>&);

template std::int64_t payload_bytes(const Snapshot&);
template std::int32_t num_chunks(const Snapshot&, std::size_t);
template Bytes encode_chunk(const Snapshot&, std::int64_t, std::int32_t, std::size_t);
template Chunk<Snapshot> decode_chunk(ByteView);
template Snapshot join(const std::vector<Chunk<Snapshot>>&);

}  // namespace kintsugi
