// The pose of the camera, and the control messages of the numbered streams.

#include <kintsugi/camera_pose_t.hpp>
#include <kintsugi/chunks_replaced_t.hpp>
#include <kintsugi/heartbeat_t.hpp>
#include <kintsugi/resend_request_t.hpp>

#include "lcmtypes/codec/small.hpp"

namespace kintsugi {
namespace codec {

static_assert(camera_pose_t::STATE_STARTING == static_cast<int>(TrackingState::kStarting));
static_assert(camera_pose_t::STATE_TRACKING == static_cast<int>(TrackingState::kTracking));
static_assert(camera_pose_t::STATE_LOST == static_cast<int>(TrackingState::kLost));
static_assert(camera_pose_t::STATE_GIVEN == static_cast<int>(TrackingState::kGiven));

template <>
struct Small<CameraPose> : Shape<camera_pose_t> {
  static constexpr int kNumStrings = 0;

  template <class From, class To>
  static void copy(const From& from, To& to) {
    to.utime = from.utime;
    to.session = from.session;
    to.frame_index = from.frame_index;
    to.state = static_cast<decltype(to.state)>(from.state);
    to.part = from.part;
  }
  static void to_wire(const CameraPose& message, camera_pose_t& wire) {
    copy(message, wire);
    pose_to_wire(message.X_WC, wire.X_WC);
  }
  static void from_wire(const camera_pose_t& wire, CameraPose& message) {
    copy(wire, message);
    message.X_WC = pose_from_wire(wire.X_WC);
  }
  static void check(const Check& check, const CameraPose& m) {
    check.not_negative("utime", m.utime);
    check.positive("session", m.session);
    check.not_negative("frame_index", m.frame_index);
    check_state(check, m.state);
    check.not_negative("part", m.part);
    check.pose("X_WC", m.X_WC);
  }
};

template <>
struct Small<Heartbeat> : Copied<Heartbeat, heartbeat_t> {
  static constexpr int kNumStrings = 2;

  template <class From, class To>
  static void copy(const From& from, To& to) {
    to.utime = from.utime;
    to.session = from.session;
    to.first_sequence = from.first_sequence;
    to.next_sequence = from.next_sequence;
    to.state_sequence = from.state_sequence;
    to.channel = from.channel;
    to.map_name = from.map_name;
  }
  static void check(const Check& check, const Heartbeat& m) {
    check.not_negative("utime", m.utime);
    check.positive("session", m.session);
    check.range<std::int64_t>("next_sequence", m.next_sequence, 0, kMaxSequence);
    check.range<std::int64_t>("first_sequence", m.first_sequence, 0, m.next_sequence);
    check.range<std::int64_t>("state_sequence", m.state_sequence, 0, m.next_sequence);
    check.text("channel", m.channel);
    check.text("map_name", m.map_name);
  }
};

/// A message of which the only array are ranges of sequence numbers.
template <class Message, class Wire>
struct Ranges : Shape<Wire> {
  static constexpr std::size_t kBytesPerCount = 2 * sizeof(std::int64_t);

  static void to_wire(const Message& message, Wire& wire) {
    Small<Message>::copy(message, wire);
    wire.num_ranges = static_cast<std::int32_t>(message.ranges.size());
    for (const SequenceRange& range : message.ranges) {
      wire.first.push_back(range.first);
      wire.last.push_back(range.last);
    }
  }
  static void from_wire(const Wire& wire, Message& message) {
    Small<Message>::copy(wire, message);
    for (std::size_t i = 0; i < wire.first.size(); ++i) {
      message.ranges.push_back({wire.first[i], wire.last[i]});
    }
  }
  static void check(const Check& check, const Message& m) {
    check.not_negative("utime", m.utime);
    check.positive("session", m.session);
    check.text("channel", m.channel);
    check.template range<std::size_t>("num_ranges", m.ranges.size(), 0, kMaxResendRanges);
    for (const SequenceRange& range : m.ranges) {
      check.template range<std::int64_t>("first", range.first, 0, kMaxSequence);
      check.template range<std::int64_t>("last", range.last, range.first, kMaxSequence);
    }
  }
};

template <>
struct Small<ResendRequest> : Ranges<ResendRequest, resend_request_t> {
  static constexpr int kNumStrings = 1;

  template <class From, class To>
  static void copy(const From& from, To& to) {
    to.utime = from.utime;
    to.session = from.session;
    to.receiver = from.receiver;
    to.channel = from.channel;
  }
};

template <>
struct Small<ChunksReplaced> : Ranges<ChunksReplaced, chunks_replaced_t> {
  static constexpr int kNumStrings = 2;

  template <class From, class To>
  static void copy(const From& from, To& to) {
    to.utime = from.utime;
    to.session = from.session;
    to.channel = from.channel;
    to.map_name = from.map_name;
  }
  static void check(const Check& check, const ChunksReplaced& m) {
    Ranges::check(check, m);
    check.text("map_name", m.map_name);
  }
};

}  // namespace codec

template Bytes encode(const CameraPose&);
template CameraPose decode(ByteView);
template Bytes encode(const Heartbeat&);
template Heartbeat decode(ByteView);
template Bytes encode(const ResendRequest&);
template ResendRequest decode(ByteView);
template Bytes encode(const ChunksReplaced&);
template ChunksReplaced decode(ByteView);

}  // namespace kintsugi
