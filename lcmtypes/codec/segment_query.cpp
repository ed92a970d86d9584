// Queries for segments, and their answers.

#include <cmath>
#include <limits>

#include <kintsugi/segment_answer_t.hpp>
#include <kintsugi/segment_query_t.hpp>

#include "lcmtypes/codec/bulk.hpp"
#include "lcmtypes/codec/small.hpp"
#include "lcmtypes/codec/statistics.hpp"

namespace kintsugi {
namespace codec {
namespace {

// A direction or axis is normalised in float32, which rounds each coordinate by up to 6e-8.
constexpr double kUnitTolerance = 1e-5;

template <class Number>
void check_unit(const Check& check, const char* field, const Number (&v)[3]) {
  for (const Number coordinate : v) check.finite(field, coordinate);
  const double x = v[0];
  const double y = v[1];
  const double z = v[2];
  const double error = std::abs(std::sqrt(x * x + y * y + z * z) - 1.0);
  if (!(error <= kUnitTolerance)) check.fail(field, error, "a unit vector, within 1e-5");
}

}  // namespace

static_assert(segment_query_t::PLACE_ANYWHERE == static_cast<int>(QueryPlace::kAnywhere));
static_assert(segment_query_t::PLACE_POINT == static_cast<int>(QueryPlace::kPoint));
static_assert(segment_query_t::PLACE_RAY == static_cast<int>(QueryPlace::kRay));
static_assert(segment_query_t::PLACE_BOX == static_cast<int>(QueryPlace::kBox));
static_assert(segment_query_t::PLACE_IDS == static_cast<int>(QueryPlace::kIds));
static_assert(segment_query_t::PLACE_PIXEL == static_cast<int>(QueryPlace::kPixel));
static_assert(segment_query_t::PLACE_VIEWS == static_cast<int>(QueryPlace::kViews));

template <>
struct Small<SegmentQuery> : Shape<segment_query_t> {
  static constexpr int kNumStrings = 1;
  static constexpr std::size_t kBytesPerCount = sizeof(std::int32_t);

  template <class From, class To>
  static void copy(const From& from, To& to) {
    to.utime = from.utime;
    to.client = from.client;
    to.number = from.number;
    to.map_session = from.map_session;
    to.map_name = from.map_name;
    to.place = static_cast<decltype(to.place)>(from.place);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      to.point_W[axis] = from.point_W[axis];
      to.direction_W[axis] = from.direction_W[axis];
      to.box_min_W[axis] = from.box_min_W[axis];
      to.box_max_W[axis] = from.box_max_W[axis];
    }
    for (std::size_t i = 0; i < 2; ++i) to.pixel_px[i] = from.pixel_px[i];
    to.radius_m = from.radius_m;
    to.only_planar = from.only_planar != 0;
    to.changed_since = from.changed_since;
    to.max_segments = from.max_segments;
  }
  static void to_wire(const SegmentQuery& message, segment_query_t& wire) {
    copy(message, wire);
    wire.num_ids = static_cast<std::int32_t>(message.segment_ids.size());
    wire.ids.assign(message.segment_ids.begin(), message.segment_ids.end());
  }
  static void from_wire(const segment_query_t& wire, SegmentQuery& message) {
    copy(wire, message);
    message.segment_ids.assign(wire.ids.begin(), wire.ids.end());
  }
  static void check(const Check& check, const SegmentQuery& m) {
    check.not_negative("utime", m.utime);
    check.positive("client", m.client);
    check.not_negative("number", m.number);
    check.not_negative("map_session", m.map_session);
    check.text("map_name", m.map_name);
    check.range("place", static_cast<int>(m.place), 0, static_cast<int>(QueryPlace::kViews));
    check_place(check, m);
    check.range("radius_m", m.radius_m, 0.0, kMaxQueryRadius_m);
    check.not_negative("changed_since", m.changed_since);
    check.not_negative("max_segments", m.max_segments);
    check.range<std::size_t>("num_ids", m.segment_ids.size(), 0, kMaxQueriedIds);
  }

 private:
  static void check_place(const Check& check, const SegmentQuery& m) {
    for (int axis = 0; axis < 3; ++axis) {
      check.finite("point_W", m.point_W[axis]);
      check.finite("direction_W", m.direction_W[axis]);
      check.finite("box_min_W", m.box_min_W[axis]);
      check.finite("box_max_W", m.box_max_W[axis]);
      if (m.place == QueryPlace::kBox && m.box_max_W[axis] < m.box_min_W[axis]) {
        check.fail("box_max_W", m.box_max_W[axis], "at least box_min_W");
      }
    }
    if (m.place == QueryPlace::kRay) check_unit(check, "direction_W", m.direction_W);
    for (const double coordinate : m.pixel_px) {
      check.range("pixel_px", coordinate, 0.0, static_cast<double>(kMaxImageSide_px));
    }
  }
};

template <>
struct Bulk<SegmentAnswer> : PlacedByByte<segment_answer_t> {
  static constexpr int kNumStrings = 1;
  static constexpr std::int16_t kRecordsVersion = kSegmentRecordsVersion;

  template <class From, class To>
  static void copy(const From& from, To& to) {
    to.utime = from.utime;
    to.session = from.session;
    to.client = from.client;
    to.number = from.number;
    to.map_session = from.map_session;
    to.map_name = from.map_name;
    to.map_slices = from.map_slices;
    to.map_points = from.map_points;
    to.map_segments = from.map_segments;
    to.num_matching = from.num_matching;
    to.has_hit = from.has_hit != 0;
    for (std::size_t axis = 0; axis < 3; ++axis) to.hit_W[axis] = from.hit_W[axis];
    to.view_utime = from.view_utime;
    to.surface_distance_m = from.surface_distance_m;
  }
  static void header_to_wire(const SegmentAnswer& answer, segment_answer_t& wire) {
    copy(answer, wire);
  }
  static void header_from_wire(const segment_answer_t& wire, SegmentAnswer& answer) {
    copy(wire, answer);
  }
  static void set_counts(segment_answer_t& wire, const Counts& counts) {
    wire.num_segments = counts[0];
    wire.num_contacts = counts[1];
    wire.problem_bytes = counts[2];
    wire.view_bytes = counts[3];
  }
  static Counts counts(const segment_answer_t& wire) {
    return {wire.num_segments, wire.num_contacts, wire.problem_bytes, wire.view_bytes};
  }

  static void check_header(const Check& check, const SegmentAnswer& answer, const Counts& counts) {
    check.not_negative("utime", answer.utime);
    check.positive("session", answer.session);
    check.positive("client", answer.client);
    check.not_negative("number", answer.number);
    check.not_negative("map_session", answer.map_session);
    check.text("map_name", answer.map_name);
    check.not_negative("map_slices", answer.map_slices);
    check.not_negative("map_points", answer.map_points);
    check.not_negative("map_segments", answer.map_segments);
    check.range<std::int64_t>("num_matching", answer.num_matching, counts[0], answer.map_segments);
    for (const float coordinate : answer.hit_W) check.finite("hit_W", coordinate);
    check.not_negative("view_utime", answer.view_utime);
    check.range("surface_distance_m", answer.surface_distance_m, 0.0F,
                std::numeric_limits<float>::max());
  }
  static void check_records(const Check& check, const SegmentAnswer& answer) {
    check.text("problem", answer.problem);
    for (const DescribedSegment& segment : answer.segments) check_segment(check, segment);
    for (const SegmentContact& contact : answer.contacts) {
      check.positive("contact segment_id", contact.segment_id);
      check.positive("contact neighbour_id", contact.neighbour_id);
      check.positive("contact num_pairs", contact.num_pairs);
    }
  }

  template <class Answer, class Function>
  static void for_each_vector(Answer& answer, const Function& function) {
    function(answer.segments);
    function(answer.contacts);
    function(answer.problem);
    function(answer.views);
  }

 private:
  static void check_segment(const Check& check, const DescribedSegment& segment) {
    constexpr float kInfinity = std::numeric_limits<float>::max();
    check_statistics(check, segment.statistics);
    check.not_negative("segment last_change_utime", segment.last_change_utime);
    for (int axis = 0; axis < 3; ++axis) {
      check.finite("segment oriented_box_center_W", segment.oriented_box_center_W[axis]);
      check_unit(check, "segment oriented_box_axes_W", segment.oriented_box_axes_W[axis]);
      check.range("segment oriented_box_size_m", segment.oriented_box_size_m[axis], 0.0F,
                  kInfinity);
    }
    const auto& normal_W = segment.plane_normal_W;
    if (normal_W[0] != 0.0F || normal_W[1] != 0.0F || normal_W[2] != 0.0F) {
      check_unit(check, "segment plane_normal_W", normal_W);
    }
    check.finite("segment plane_offset_m", segment.plane_offset_m);
    check.range("segment plane_rms_m", segment.plane_rms_m, 0.0F, kInfinity);
    check.range("segment plane_share", segment.plane_share, 0.0F, 1.0F);
    check.range("segment distance_m", segment.distance_m, 0.0F, kInfinity);
    check.range<std::uint32_t>("segment is_planar", segment.is_planar, 0, 1);
  }
};

}  // namespace codec

template Bytes encode(const SegmentQuery&);
template SegmentQuery decode(ByteView);

template std::int64_t payload_bytes(const SegmentAnswer&);
template std::int32_t num_chunks(const SegmentAnswer&, std::size_t);
template Bytes encode_chunk(const SegmentAnswer&, std::int64_t, std::int32_t, std::size_t);
template Chunk<SegmentAnswer> decode_chunk(ByteView);
template SegmentAnswer join(const std::vector<Chunk<SegmentAnswer>>&);

}  // namespace kintsugi
