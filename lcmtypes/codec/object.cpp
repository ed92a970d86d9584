// Detections of objects, and changes between maps.

#include <kintsugi/change_report_t.hpp>
#include <kintsugi/object_detection_t.hpp>

#include "lcmtypes/codec/small.hpp"

namespace kintsugi {
namespace codec {
namespace {

/// What the two messages have in common: each tells the last event of one thing of a session.
template <class Message>
void check_event(const Check& check, const Message& m) {
  check.not_negative("utime", m.utime);
  check.positive("session", m.session);
  check.positive("map_session", m.map_session);
  check.range<std::int64_t>("event_number", m.event_number, 1, kMaxSequence);
  check.range("score", m.score, 0.0F, 1.0F);
  check.not_negative("points", m.points);
  check.text("map_name", m.map_name);
}

void check_number(const Check& check, const char* field, std::int32_t number,
                  const char* count_field, std::int32_t count) {
  check.positive(count_field, count);
  check.range(field, number, 1, count);
}

void check_box(const Check& check, const char* min_field, const float (&low)[3],
               const char* max_field, const float (&high)[3]) {
  for (int axis = 0; axis < 3; ++axis) {
    check.position(min_field, low[axis]);
    check.position(max_field, high[axis]);
    if (high[axis] < low[axis]) {
      check.fail(max_field, high[axis], std::string("at least ") + min_field);
    }
  }
}

void check_segments(const Check& check, const std::vector<std::uint32_t>& ids) {
  check.range<std::size_t>("num_segments", ids.size(), 0, kMaxObjectSegments);
  std::uint32_t before = kNoSegment;
  for (const std::uint32_t id : ids) {
    if (id <= before) check.fail("segment_ids", id, "> " + std::to_string(before) + ", ascending");
    before = id;
  }
}

template <class Message, class Wire>
void segments_to_wire(const Message& message, Wire& wire) {
  wire.num_segments = static_cast<std::int32_t>(message.segment_ids.size());
  wire.segment_ids.assign(message.segment_ids.begin(), message.segment_ids.end());
}

}  // namespace

static_assert(object_detection_t::EVENT_FOUND == static_cast<int>(DetectionEvent::kFound));
static_assert(object_detection_t::EVENT_CONFIRMED == static_cast<int>(DetectionEvent::kConfirmed));
static_assert(object_detection_t::EVENT_MOVED == static_cast<int>(DetectionEvent::kMoved));
static_assert(object_detection_t::EVENT_GONE == static_cast<int>(DetectionEvent::kGone));
static_assert(change_report_t::KIND_NEW == static_cast<int>(ChangeKind::kNew));
static_assert(change_report_t::KIND_GONE == static_cast<int>(ChangeKind::kGone));
static_assert(change_report_t::KIND_MOVED == static_cast<int>(ChangeKind::kMoved));
static_assert(change_report_t::KIND_WITHDRAWN == static_cast<int>(ChangeKind::kWithdrawn));

template <>
struct Small<ObjectDetection> : Shape<object_detection_t> {
  static constexpr int kNumStrings = 2;
  static constexpr std::size_t kBytesPerCount = sizeof(std::int32_t);

  template <class From, class To>
  static void copy(const From& from, To& to) {
    to.utime = from.utime;
    to.session = from.session;
    to.map_session = from.map_session;
    to.map_name = from.map_name;
    to.detection = from.detection;
    to.num_detections = from.num_detections;
    to.event_number = from.event_number;
    to.event = static_cast<decltype(to.event)>(from.event);
    to.name = from.name;
    to.score = from.score;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      to.box_min_O[axis] = from.box_min_O[axis];
      to.box_max_O[axis] = from.box_max_O[axis];
    }
    to.points = from.points;
  }
  static void to_wire(const ObjectDetection& message, object_detection_t& wire) {
    copy(message, wire);
    pose_to_wire(message.X_WO, wire.X_WO);
    segments_to_wire(message, wire);
  }
  static void from_wire(const object_detection_t& wire, ObjectDetection& message) {
    copy(wire, message);
    message.X_WO = pose_from_wire(wire.X_WO);
    message.segment_ids.assign(wire.segment_ids.begin(), wire.segment_ids.end());
  }
  static void check(const Check& check, const ObjectDetection& m) {
    check_event(check, m);
    check_number(check, "detection", m.detection, "num_detections", m.num_detections);
    check.range("event", static_cast<int>(m.event), 0, static_cast<int>(DetectionEvent::kGone));
    check.text("name", m.name);
    if (!is_object_name(m.name)) {
      check.fail("name", '\'' + m.name + '\'', "1 to 64 letters, digits, - and _");
    }
    check.pose("X_WO", m.X_WO);
    check_box(check, "box_min_O", m.box_min_O, "box_max_O", m.box_max_O);
    check_segments(check, m.segment_ids);
  }
};

template <>
struct Small<ChangeReport> : Shape<change_report_t> {
  static constexpr int kNumStrings = 2;
  static constexpr std::size_t kBytesPerCount = sizeof(std::int32_t);

  template <class From, class To>
  static void copy(const From& from, To& to) {
    to.utime = from.utime;
    to.session = from.session;
    to.map_session = from.map_session;
    to.map_name = from.map_name;
    to.before = from.before;
    to.change = from.change;
    to.num_changes = from.num_changes;
    to.event_number = from.event_number;
    to.kind = static_cast<decltype(to.kind)>(from.kind);
    to.score = from.score;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      to.box_min_W[axis] = from.box_min_W[axis];
      to.box_max_W[axis] = from.box_max_W[axis];
    }
    to.points = from.points;
  }
  static void to_wire(const ChangeReport& message, change_report_t& wire) {
    copy(message, wire);
    pose_to_wire(message.motion_W, wire.motion_W);
    segments_to_wire(message, wire);
  }
  static void from_wire(const change_report_t& wire, ChangeReport& message) {
    copy(wire, message);
    message.motion_W = pose_from_wire(wire.motion_W);
    message.segment_ids.assign(wire.segment_ids.begin(), wire.segment_ids.end());
  }
  static void check(const Check& check, const ChangeReport& m) {
    check_event(check, m);
    check_number(check, "change", m.change, "num_changes", m.num_changes);
    check.range("kind", static_cast<int>(m.kind), 0, static_cast<int>(ChangeKind::kWithdrawn));
    check.text("before", m.before);
    check.pose("motion_W", m.motion_W);
    if ((m.kind == ChangeKind::kNew || m.kind == ChangeKind::kGone) &&
        m.motion_W.matrix() != Pose::Identity().matrix()) {
      check.fail("motion_W", "a motion", "the identity, as the object did not move");
    }
    check_box(check, "box_min_W", m.box_min_W, "box_max_W", m.box_max_W);
    check_segments(check, m.segment_ids);
    if (m.kind == ChangeKind::kGone && !m.segment_ids.empty()) {
      check.fail("num_segments", m.segment_ids.size(), "0, as the object is gone");
    }
  }
};

}  // namespace codec

template Bytes encode(const ObjectDetection&);
template ObjectDetection decode(ByteView);
template Bytes encode(const ChangeReport&);
template ChangeReport decode(ByteView);

}  // namespace kintsugi
