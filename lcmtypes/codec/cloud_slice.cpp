#include <algorithm>

#include <kintsugi/cloud_slice_t.hpp>

#include "lcmtypes/codec/bulk.hpp"

namespace kintsugi {
namespace codec {

static_assert(cloud_slice_t::KIND_FINAL == static_cast<int>(SliceKind::kFinal));
static_assert(cloud_slice_t::KIND_SHIFT_PLUS_X == static_cast<int>(SliceKind::kShiftPlusX));
static_assert(cloud_slice_t::KIND_SHIFT_MINUS_X == static_cast<int>(SliceKind::kShiftMinusX));
static_assert(cloud_slice_t::KIND_SHIFT_PLUS_Y == static_cast<int>(SliceKind::kShiftPlusY));
static_assert(cloud_slice_t::KIND_SHIFT_MINUS_Y == static_cast<int>(SliceKind::kShiftMinusY));
static_assert(cloud_slice_t::KIND_SHIFT_PLUS_Z == static_cast<int>(SliceKind::kShiftPlusZ));
static_assert(cloud_slice_t::KIND_SHIFT_MINUS_Z == static_cast<int>(SliceKind::kShiftMinusZ));
static_assert(cloud_slice_t::KIND_PATCH == static_cast<int>(SliceKind::kPatch));
static_assert(cloud_slice_t::KIND_CORRECTION == static_cast<int>(SliceKind::kCorrection));
static_assert(sizeof(CloudPoint) == sizeof(PatchMotion));
static_assert(sizeof(CloudPoint) == sizeof(LoopLink));

template <>
struct Bulk<CloudSlice> {
  using WireType = cloud_slice_t;
  static constexpr int kNumStrings = 1;
  static constexpr std::int16_t kRecordsVersion = kCloudPointVersion;
  static constexpr std::size_t kAlignment = sizeof(CloudPoint);  // whole records in each chunk

  template <class From, class To>
  static void copy(const From& from, To& to) {
    to.utime = from.utime;
    to.session = from.session;
    to.revision = from.revision;
    to.kind = static_cast<decltype(to.kind)>(from.kind);
    to.in_volume = from.in_volume != 0;
    to.ends_batch = from.ends_batch != 0;
    to.superseded = from.superseded != 0;
    to.revision_sum = from.revision_sum;
    to.part = from.part;
    to.correction = from.correction;
    to.keyframe = from.keyframe;
    to.resolution_m = from.resolution_m;
    to.map_name = from.map_name;
  }
  static void header_to_wire(const CloudSlice& slice, cloud_slice_t& wire) {
    copy(slice, wire);
    wire.slice_id = slice.id;
    pose_to_wire(slice.X_WC, wire.X_WC);
    std::ranges::copy(slice.X_WP.t_WP, wire.t_WP);
    std::ranges::copy(slice.X_WP.q_WP, wire.q_WP);
  }
  static void header_from_wire(const cloud_slice_t& wire, CloudSlice& slice) {
    copy(wire, slice);
    slice.id = wire.slice_id;
    slice.X_WC = pose_from_wire(wire.X_WC);
    std::ranges::copy(wire.t_WP, slice.X_WP.t_WP);
    std::ranges::copy(wire.q_WP, slice.X_WP.q_WP);
  }
  static void set_counts(cloud_slice_t& wire, const Counts& counts) {
    wire.total_points = counts[0];
    wire.total_motions = counts[1];
    wire.total_loops = counts[2];
  }
  static Counts counts(const cloud_slice_t& wire) {
    return {wire.total_points, wire.total_motions, wire.total_loops, 0};
  }

  static void set_part(cloud_slice_t& wire, std::int64_t first_byte, std::size_t num_bytes) {
    wire.first_record = static_cast<std::int32_t>(first_byte / kAlignment);
    wire.num_records = static_cast<std::int32_t>(num_bytes / kAlignment);
    wire.num_bytes = static_cast<std::int32_t>(num_bytes);
  }
  static std::int64_t first_byte(const Check& check, const cloud_slice_t& wire) {
    check.not_negative("num_records", wire.num_records);
    if (static_cast<std::size_t>(wire.num_records) * kAlignment != wire.data.size()) {
      check.fail("num_bytes", wire.num_bytes,
                 "32 * num_records, which is " + std::to_string(wire.num_records));
    }
    return std::int64_t{wire.first_record} * static_cast<std::int64_t>(kAlignment);
  }

  static void check_header(const Check& check, const CloudSlice& slice, const Counts& counts) {
    check.not_negative("utime", slice.utime);
    check.positive("session", slice.session);
    check.not_negative("slice_id", slice.id);
    check.not_negative("revision", slice.revision);
    check.range("kind", static_cast<int>(slice.kind), 0, static_cast<int>(SliceKind::kCorrection));
    check.not_negative("revision_sum", slice.revision_sum);
    if (slice.superseded && counts[0] > 0) check.fail("total_points", counts[0], "0, superseded");
    check.not_negative("part", slice.part);
    if (slice.keyframe < -1) check.fail("keyframe", slice.keyframe, ">= -1");
    check.range("resolution_m", slice.resolution_m, kMinResolution_m, kMaxResolution_m);
    check.pose("X_WC", slice.X_WC);
    check.text("map_name", slice.map_name);
    check_correction(check, slice, counts);
  }
  /// A point may have any values: the segmenter rejects and counts the points that it cannot use.
  static void check_records(const Check& check, const CloudSlice& slice) {
    std::int64_t lowest_id = 0;
    for (const PatchMotion& motion : slice.motions) {
      if (motion.id < lowest_id) {
        check.fail("motion slice_id", motion.id, ">= " + std::to_string(lowest_id) + ", ascending");
      }
      lowest_id = std::int64_t{motion.id} + 1;
      check_patch_pose(check, "motion t_WP", "motion q_WP", motion.X_WP);
    }
    for (const LoopLink& loop : slice.loops) {
      check.not_negative("loop later", loop.later);
      check.not_negative("loop earlier", loop.earlier);
      for (const float p : loop.later_W) check.position("loop later_W", p);
      for (const float p : loop.earlier_W) check.position("loop earlier_W", p);
    }
  }

  template <class Slice, class Function>
  static void for_each_vector(Slice& slice, const Function& function) {
    function(slice.points_W);
    function(slice.motions);
    function(slice.loops);
  }

 private:
  static void check_correction(const Check& check, const CloudSlice& slice, const Counts& counts) {
    const bool is_correction = slice.kind == SliceKind::kCorrection;
    check_patch_pose(check, "t_WP", "q_WP", slice.X_WP);
    if (!is_correction && slice.kind != SliceKind::kPatch && !slice.X_WP.is_identity()) {
      check.fail("X_WP", "a motion", "the identity, as the slice is neither patch nor correction");
    }
    if (is_correction) {
      check.positive("correction", slice.correction);
      if (slice.revision != 0) check.fail("revision", slice.revision, "0, in a correction");
      if (counts[0] != 0) check.fail("total_points", counts[0], "0, in a correction");
    } else {
      check.not_negative("correction", slice.correction);
      if (counts[1] != 0) check.fail("total_motions", counts[1], "0, as it is no correction");
      if (counts[2] != 0) check.fail("total_loops", counts[2], "0, as it is no correction");
    }
  }
  static void check_patch_pose(const Check& check, const char* t_WP, const char* q_WP,
                               const PatchPose& X_WP) {
    for (const float t : X_WP.t_WP) check.position(t_WP, t);
    if (!X_WP.is_valid()) {
      check.fail(q_WP, X_WP.length(), "a unit quaternion, length 1 within 1e-5");
    }
  }
};

}  // namespace codec

template std::int64_t payload_bytes(const CloudSlice&);
template std::int32_t num_chunks(const CloudSlice&, std::size_t);
template Bytes encode_chunk(const CloudSlice&, std::int64_t, std::int32_t, std::size_t);
template Chunk<CloudSlice> decode_chunk(ByteView);
template CloudSlice join(const std::vector<Chunk<CloudSlice>>&);

}  // namespace kintsugi
