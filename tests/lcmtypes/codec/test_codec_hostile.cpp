#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lcmtypes/codec/checksum.hpp"
#include "lcmtypes/codec/codec.hpp"
#include "tests/support/allocation_limit.hpp"
#include "tests/support/example_messages.hpp"

namespace kintsugi {
namespace {

using namespace testing;  // NOLINT: the examples
using ::testing::AllOf;
using ::testing::HasSubstr;

// A decoder holds the message a few times (as LCM's struct, as ours, as the identity), and makes a
// text when it refuses one. A decoder that trusts a count would take megabytes.
std::size_t allocation_limit(std::size_t message_bytes) { return 8 * message_bytes + 16'384; }

struct Subject {
  const char* name;
  Bytes message;
  std::function<void(ByteView)> decode;
};

template <SmallMessage Message>
Subject small(const char* name, const Message& message) {
  return {name, encode(message), [](ByteView data) { (void)decode<Message>(data); }};
}

template <BulkMessage Message>
Subject bulk(const char* name, const Message& message) {
  return {name, encode_chunk(message, 0, 0, kDefaultMaxChunkBytes),
          [](ByteView data) { (void)join(std::vector{decode_chunk<Message>(data)}); }};
}

std::vector<Subject> subjects() {
  return {small("camera_pose", example_camera_pose()),
          small("mapper_status", example_mapper_status()),
          small("segmenter_status", example_segmenter_status()),
          small("viewer_status", example_viewer_status()),
          small("heartbeat", example_heartbeat()),
          small("resend_request", example_resend_request()),
          small("chunks_replaced", example_chunks_replaced()),
          small("segment_query", example_query()),
          small("detector_status", example_detector_status()),
          small("object_detection", example_detection()),
          small("change_report", example_change()),
          bulk("cloud_slice", example_slice(10)),
          bulk("patch", example_patch(6)),
          bulk("correction", example_correction(9)),
          bulk("segment_update", example_update(12)),
          bulk("segment_answer", example_answer(4)),
          bulk("rgbd_frame", example_frame(40, 30)),
          bulk("view", example_view(50)),
          bulk("keyframe", example_keyframe(3)),
          bulk("snapshot", example_snapshot(50))};
}

/// The message of a malicious sender: with invalid content, and the right checksum.
Bytes with_checksum(Bytes message) {
  if (message.size() >= codec::kChecksumEnd) codec::set_checksum(message);
  return message;
}

/// True if `data` decodes. An exception other than DecodeError or a large allocation fails the
/// test.
bool decodes(const Subject& subject, ByteView data) {
  bool valid = false;
  const std::size_t allocated = allocated_by([&] {
    try {
      subject.decode(data);
      valid = true;
    } catch (const DecodeError&) {
    }
  });
  EXPECT_LE(allocated, allocation_limit(data.size())) << subject.name;
  return valid;
}

TEST(CodecHostile, EveryTruncationIsRefused) {
  for (const Subject& subject : subjects()) {
    ASSERT_TRUE(decodes(subject, subject.message)) << subject.name;
    for (std::size_t size = 0; size < subject.message.size(); ++size) {
      const Bytes cut(subject.message.begin(), subject.message.begin() + static_cast<int>(size));
      EXPECT_FALSE(decodes(subject, cut)) << subject.name << " cut to " << size;
      EXPECT_FALSE(decodes(subject, with_checksum(cut))) << subject.name << " cut to " << size;
    }
  }
}

TEST(CodecHostile, TrailingBytesAreRefused) {
  for (const Subject& subject : subjects()) {
    Bytes longer = subject.message;
    longer.push_back(0);
    EXPECT_FALSE(decodes(subject, longer)) << subject.name;
    EXPECT_FALSE(decodes(subject, with_checksum(longer))) << subject.name;
  }
}

TEST(CodecHostile, OtherTypesAreRefused) {
  for (const Subject& subject : subjects()) {
    for (const Subject& other : subjects()) {
      const bool is_same_type = std::equal(subject.message.begin(), subject.message.begin() + 8,
                                           other.message.begin());  // the fingerprint
      if (is_same_type) continue;
      EXPECT_FALSE(decodes(subject, other.message)) << other.name << " as " << subject.name;
    }
  }
}

TEST(CodecHostile, AChangedByteAnywhereIsRefused) {
  for (const Subject& subject : subjects()) {
    for (std::size_t place = 0; place < subject.message.size(); ++place) {
      for (const int change : {0x01, 0x80, 0xFF}) {
        Bytes mutated = subject.message;
        mutated[place] = static_cast<std::uint8_t>(mutated[place] ^ change);
        EXPECT_FALSE(decodes(subject, mutated)) << subject.name << ", byte " << place;
      }
    }
  }
}

TEST(CodecHostile, OnlyRawFramesMayHaveNoChecksum) {
  for (const Subject& subject : subjects()) {
    Bytes message = subject.message;
    std::fill_n(message.begin() + codec::kChecksumPlace, 4, std::uint8_t{0});
    EXPECT_EQ(decodes(subject, message), subject.name == std::string("rgbd_frame")) << subject.name;
  }
}

TEST(CodecHostile, AMutatedMessageEitherDecodesOrIsRefused) {
  std::mt19937 random(1);
  for (const Subject& subject : subjects()) {
    int valid = 0;
    for (int trial = 0; trial < 4'000; ++trial) {
      Bytes mutated = subject.message;
      for (int i = 1 + static_cast<int>(random() % 4); i > 0; --i) {
        mutated[random() % mutated.size()] = static_cast<std::uint8_t>(random());
      }
      valid += decodes(subject, with_checksum(mutated)) ? 1 : 0;
    }
    // Fields without bounds (times, points) may change; changes of other fields must be refused.
    EXPECT_GT(valid, 0) << subject.name;
    EXPECT_LT(valid, 4'000) << subject.name;
  }
}

TEST(CodecHostile, AHugeCountAnywhereAllocatesLittle) {
  for (const Subject& subject : subjects()) {
    for (const std::uint32_t claim : {0x7FFFFFFFU, 0x77359400U, 0x80000000U, 0xFFFFFFFFU, 0U}) {
      for (std::size_t place = codec::kChecksumEnd; place + 4 <= subject.message.size(); ++place) {
        Bytes mutated = subject.message;
        for (int i = 0; i < 4; ++i) {
          mutated[place + static_cast<std::size_t>(i)] =
              static_cast<std::uint8_t>(claim >> (24 - 8 * i));
        }
        decodes(subject, with_checksum(mutated));
      }
    }
  }
}

TEST(CodecHostile, RandomBytesAreRefused) {
  std::mt19937 random(2);
  for (const Subject& subject : subjects()) {
    for (int trial = 0; trial < 200; ++trial) {
      Bytes noise(random() % 400);
      for (auto& byte : noise) byte = static_cast<std::uint8_t>(random());
      // With the right fingerprint, so that the checks behind it are tested.
      if (noise.size() >= 8 && trial % 2 == 0) {
        std::copy_n(subject.message.begin(), 8, noise.begin());
      }
      EXPECT_FALSE(decodes(subject, with_checksum(noise))) << subject.name;
    }
  }
}

template <class Message, class Change>
std::string refusal(Message message, const Change& change) {
  change(message);
  try {
    if constexpr (BulkMessage<Message>) {
      (void)num_chunks(message, kDefaultMaxChunkBytes);
    } else {
      (void)encode(message);
    }
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "accepted";
}

TEST(CodecBounds, AKeyframeIsOneOfAChain) {
  const auto why = [](const std::function<void(KeyframeMessage&)>& change) {
    return refusal(example_keyframe(1), change);
  };
  EXPECT_THAT(why([](KeyframeMessage& k) { k.previous = k.number; }),
              HasSubstr("keyframe_t.previous is 7, expected -1 .. 6"));
  EXPECT_THAT(why([](KeyframeMessage& k) { k.tracked_from = k.previous + 1; }),
              HasSubstr("tracked_from is 6"));
  EXPECT_THAT(why([](KeyframeMessage& k) { k.in_volume.push_back(k.number); }),
              HasSubstr("in_volume is 7"));
  EXPECT_THAT(why([](KeyframeMessage& k) { k.depth.pop_back(); }), HasSubstr("num_depths is 47"));
  EXPECT_THAT(why([](KeyframeMessage& k) { k.intensity.pop_back(); }),
              HasSubstr("num_intensities is 47"));
  EXPECT_THAT(why([](KeyframeMessage& k) { k.information_K(0, 0) = -1.0; }),
              HasSubstr("information is -1"));
  EXPECT_THAT(why([](KeyframeMessage& k) { k.information_K(0, 1) += 1.0; }),
              HasSubstr("a symmetric matrix"));
  EXPECT_THAT(why([](KeyframeMessage& k) { k.information_K(0, 0) = 0.0; }),
              HasSubstr("information is"));
  // Each entry is within those on the diagonal, and yet it is no sum of squares.
  EXPECT_THAT(why([](KeyframeMessage& k) {
                k.information_K.setIdentity();
                for (int i = 0; i + 1 < 6; ++i) {
                  k.information_K(i, i + 1) = k.information_K(i + 1, i) = -0.99;
                }
              }),
              HasSubstr("no eigenvalue below 0"));
  EXPECT_THAT(why([](KeyframeMessage& k) { k.part = 2'000'000'000; }),
              HasSubstr("part is 2000000000, expected 0 .. 1000000"));
  EXPECT_THAT(why([](KeyframeMessage& k) { k.features[0].ray_x = std::nanf(""); }),
              HasSubstr("ray_x"));
  EXPECT_THAT(why([](KeyframeMessage& k) { k.join = std::string(257, 'x'); }),
              HasSubstr("join is 257, expected 0 .. 256"));
}

TEST(CodecBounds, ErrorsNameTypeFieldValueAndBound) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(refusal(example_slice(1), [](CloudSlice& s) { s.resolution_m = 0; }),
              AllOf(HasSubstr("cloud_slice_t.resolution_m"), HasSubstr("is 0,"), HasSubstr("..")));
  EXPECT_THAT(refusal(example_slice(1), [](CloudSlice& s) { s.session = 0; }),
              HasSubstr("cloud_slice_t.session is 0, expected > 0"));
  EXPECT_THAT(refusal(example_slice(1), [](CloudSlice& s) { s.id = -1; }), HasSubstr("slice_id"));
  EXPECT_THAT(refusal(example_slice(1), [](CloudSlice& s) { s.kind = SliceKind{9}; }),
              HasSubstr("kind is 9"));
  EXPECT_THAT(refusal(example_slice(1), [](CloudSlice& s) { s.revision_sum = -1; }),
              HasSubstr("revision_sum is -1"));
  EXPECT_THAT(refusal(example_view(1), [](CameraView& v) { v.depth_step = 0; }),
              HasSubstr("camera_view_t.depth_step is 0, expected 1 .. 50"));
  EXPECT_THAT(refusal(example_view(1), [](CameraView& v) { v.depth_mm.pop_back(); }),
              HasSubstr("num_depths is 47, expected 48 .. 48"));
  EXPECT_THAT(refusal(example_view(1), [](CameraView& v) { v.intrinsics.distortion[0] = 0.1; }),
              HasSubstr("distortion is 0.1"));
  EXPECT_THAT(refusal(example_slice(1), [](CloudSlice& s) { s.part = -1; }), HasSubstr("part"));
  EXPECT_THAT(refusal(example_slice(1), [](CloudSlice& s) { s.keyframe = -2; }),
              HasSubstr("keyframe is -2, expected >= -1"));
  EXPECT_THAT(refusal(example_slice(1), [](CloudSlice& s) { s.X_WC.linear() *= 1.001; }),
              AllOf(HasSubstr("X_WC"), HasSubstr("a rotation")));
  EXPECT_THAT(refusal(example_slice(1), [](CloudSlice& s) { s.X_WC.linear().col(0) *= -1.0; }),
              HasSubstr("determinant"));
  EXPECT_THAT(refusal(example_slice(1), [&](CloudSlice& s) { s.X_WC.translation().x() = nan; }),
              HasSubstr("X_WC is nan"));
  EXPECT_THAT(refusal(example_slice(1), [&](CloudSlice& s) { s.X_WC.linear()(1, 1) = nan; }),
              HasSubstr("X_WC is nan"));
  EXPECT_THAT(refusal(example_slice(1), [](CloudSlice& s) { s.map_name = std::string(1025, 'a'); }),
              HasSubstr("map_name is 1025 bytes long"));
  EXPECT_THAT(refusal(example_slice(1), [](CloudSlice& s) { s.map_name = "\x1b[2J"; }),
              HasSubstr("control"));
  EXPECT_THAT(refusal(example_slice(1), [](CloudSlice& s) { s.map_name = std::string("a\0b", 3); }),
              HasSubstr("control"));
  EXPECT_THAT(refusal(example_update(1),
                      [](SegmentUpdate& u) {
                        u.runs = {{0, 0, 0, 1}};
                      }),
              HasSubstr("run count is 0"));
  EXPECT_THAT(refusal(example_update(1), [](SegmentUpdate& u) { u.runs[0].slice_revision = -1; }),
              HasSubstr("run slice_revision is -1"));
  EXPECT_THAT(refusal(example_update(1),
                      [](SegmentUpdate& u) {
                        u.events = {{SegmentEventType{5}, 1, 0}};
                      }),
              HasSubstr("event type is 5"));
  EXPECT_THAT(refusal(example_update(1),
                      [&](SegmentUpdate& u) { u.statistics[0].area_m2 = std::nanf(""); }),
              HasSubstr("statistics area is nan"));
  EXPECT_THAT(refusal(example_query(), [](SegmentQuery& q) { q.place = QueryPlace{7}; }),
              HasSubstr("segment_query_t.place is 7, expected 0 .. 6"));
  EXPECT_THAT(refusal(example_query(), [](SegmentQuery& q) { q.pixel_px[1] = -1.0; }),
              HasSubstr("pixel_px is -1"));
  EXPECT_THAT(refusal(example_query(), [](SegmentQuery& q) { q.client = 0; }),
              HasSubstr("client is 0, expected > 0"));
  EXPECT_THAT(refusal(example_query(), [](SegmentQuery& q) { q.direction_W[0] = 0.01; }),
              AllOf(HasSubstr("direction_W"), HasSubstr("a unit vector")));
  EXPECT_THAT(refusal(example_query(), [&](SegmentQuery& q) { q.point_W[2] = nan; }),
              HasSubstr("point_W is nan"));
  EXPECT_THAT(refusal(example_query(), [&](SegmentQuery& q) { q.radius_m = nan; }),
              HasSubstr("radius_m is nan"));
  EXPECT_THAT(refusal(example_query(),
                      [](SegmentQuery& q) {
                        q.place = QueryPlace::kBox;
                        q.box_max_W[1] = -3.0;
                      }),
              HasSubstr("box_max_W is -3, expected at least box_min_W"));
  EXPECT_THAT(refusal(example_query(), [](SegmentQuery& q) { q.segment_ids.resize(4'097); }),
              HasSubstr("num_ids is 4097, expected 0 .. 4096"));
  EXPECT_THAT(refusal(example_answer(1), [](SegmentAnswer& a) { a.num_matching = 0; }),
              HasSubstr("num_matching is 0, expected 1 .. 321000"));
  EXPECT_THAT(refusal(example_answer(0), [](SegmentAnswer& a) { a.problem = "\x1b[2J"; }),
              HasSubstr("control"));
  EXPECT_THAT(refusal(example_answer(1), [](SegmentAnswer& a) { a.segments[0].is_planar = 2; }),
              HasSubstr("is_planar is 2"));
  EXPECT_THAT(refusal(example_answer(1),
                      [](SegmentAnswer& a) { a.segments[0].oriented_box_axes_W[1][1] = 1.001F; }),
              AllOf(HasSubstr("oriented_box_axes_W"), HasSubstr("a unit vector")));
  EXPECT_THAT(refusal(example_answer(1), [](SegmentAnswer& a) { a.contacts[0].num_pairs = 0; }),
              HasSubstr("num_pairs is 0"));
  EXPECT_THAT(refusal(example_frame(1, 1), [](RgbdFrameMessage& f) { f.intrinsics.fx = 0; }),
              HasSubstr("rgbd_frame_t.fx is 0"));
  EXPECT_THAT(refusal(example_frame(1, 1), [](RgbdFrameMessage& f) { f.intrinsics.height = 0; }),
              HasSubstr("height is 0"));
  EXPECT_THAT(refusal(example_frame(0, 1), [](RgbdFrameMessage&) {}),
              HasSubstr("depth_bytes is 0"));
  EXPECT_THAT(refusal(example_mapper_status(), [&](MapperStatus& s) { s.track_ms = nan; }),
              HasSubstr("mapper_status_t.track_ms is nan, expected a finite number"));
  EXPECT_THAT(refusal(example_mapper_status(), [](MapperStatus& s) { s.frames_total = -2; }),
              HasSubstr("frames_total is -2, expected >= -1"));
  EXPECT_THAT(refusal(example_mapper_status(), [](MapperStatus& s) { s.undetermined = 7; }),
              HasSubstr("undetermined is 7, expected 0 .. 6"));
  EXPECT_THAT(refusal(example_heartbeat(), [](Heartbeat& h) { h.first_sequence = 18; }),
              HasSubstr("first_sequence is 18, expected 0 .. 17"));
  EXPECT_THAT(refusal(example_heartbeat(), [](Heartbeat& h) { h.state_sequence = 18; }),
              HasSubstr("state_sequence is 18, expected 0 .. 17"));
  EXPECT_THAT(refusal(example_heartbeat(), [](Heartbeat& h) { h.state_sequence = -1; }),
              HasSubstr("state_sequence is -1"));
  EXPECT_THAT(refusal(example_mapper_status(), [](MapperStatus& s) { s.store_bytes = -1; }),
              HasSubstr("mapper_status_t.store_bytes is -1, expected >= 0"));
  EXPECT_THAT(refusal(example_segmenter_status(), [](SegmenterStatus& s) { s.problem = "a\nb"; }),
              HasSubstr("segmenter_status_t.problem is a text with byte 10"));
  EXPECT_THAT(refusal(example_resend_request(),
                      [](ResendRequest& r) {
                        r.ranges = {{5, 4}};
                      }),
              HasSubstr("last is 4"));
}

template <class Change>
std::string refusal_of_detection(const Change& change) {
  return refusal(example_detection(), change);
}

TEST(CodecBounds, ADetectionIsOneOfItsSession) {
  EXPECT_EQ(refusal_of_detection([](ObjectDetection&) {}), "accepted");
  EXPECT_THAT(refusal_of_detection([](ObjectDetection& d) { d.session = 0; }),
              HasSubstr("object_detection_t.session is 0, expected > 0"));
  EXPECT_THAT(refusal_of_detection([](ObjectDetection& d) { d.map_session = 0; }),
              HasSubstr("map_session is 0, expected > 0"));
  EXPECT_THAT(refusal_of_detection([](ObjectDetection& d) { d.detection = 0; }),
              HasSubstr("detection is 0, expected 1 .. 5"));
  EXPECT_THAT(refusal_of_detection([](ObjectDetection& d) { d.detection = 6; }),
              HasSubstr("detection is 6, expected 1 .. 5"));
  EXPECT_THAT(refusal_of_detection([](ObjectDetection& d) { d.num_detections = 0; }),
              HasSubstr("num_detections is 0, expected > 0"));
  EXPECT_THAT(refusal_of_detection([](ObjectDetection& d) { d.event_number = 0; }),
              HasSubstr("event_number is 0, expected 1 .. "));
  EXPECT_THAT(refusal_of_detection([](ObjectDetection& d) { d.event = DetectionEvent{4}; }),
              HasSubstr("event is 4, expected 0 .. 3"));
}

TEST(CodecBounds, ADetectionHasAnObjectAPoseABoxAndSegments) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const std::string name : {"", "a b", "../etc", "a.ply", "caf\xc3\xa9"}) {
    EXPECT_THAT(refusal_of_detection([&](ObjectDetection& d) { d.name = name; }),
                HasSubstr("name is '" + name + "', expected 1 to 64 letters, digits, - and _"));
  }
  EXPECT_EQ(refusal_of_detection([](ObjectDetection& d) { d.name = std::string(64, 'Z'); }),
            "accepted");
  EXPECT_THAT(refusal_of_detection([](ObjectDetection& d) { d.name = std::string(65, 'Z'); }),
              HasSubstr("expected 1 to 64"));
  EXPECT_THAT(refusal_of_detection([](ObjectDetection& d) { d.X_WO.linear() *= 1.001; }),
              AllOf(HasSubstr("X_WO"), HasSubstr("a rotation")));
  for (const float score : {-0.01F, 1.01F, nan}) {
    EXPECT_THAT(refusal_of_detection([&](ObjectDetection& d) { d.score = score; }),
                AllOf(HasSubstr("score is"), HasSubstr("expected 0 .. 1")));
  }
  EXPECT_THAT(refusal_of_detection([&](ObjectDetection& d) { d.box_min_O[1] = nan; }),
              HasSubstr("box_min_O is nan"));
  EXPECT_THAT(refusal_of_detection([](ObjectDetection& d) { d.box_max_O[2] = 2e6F; }),
              HasSubstr("box_max_O is 2e+06"));
  EXPECT_THAT(refusal_of_detection([](ObjectDetection& d) { d.box_max_O[0] = -1.0F; }),
              HasSubstr("box_max_O is -1, expected at least box_min_O"));
  EXPECT_THAT(refusal_of_detection([](ObjectDetection& d) { d.points = -1; }),
              HasSubstr("points is -1"));
  EXPECT_THAT(refusal_of_detection([](ObjectDetection& d) {
                d.segment_ids = {7, 7};
              }),
              HasSubstr("segment_ids is 7, expected > 7, ascending"));
  EXPECT_THAT(refusal_of_detection([](ObjectDetection& d) { d.segment_ids = {kNoSegment}; }),
              HasSubstr("segment_ids is 0, expected > 0"));
  EXPECT_THAT(refusal_of_detection([](ObjectDetection& d) { d.segment_ids.resize(1'025); }),
              HasSubstr("num_segments is 1025, expected 0 .. 1024"));
}

template <class Change>
std::string refusal_of_change(const Change& change) {
  return refusal(example_change(), change);
}

TEST(CodecBounds, OnlyAMovedObjectHasAMotionAndAGoneOneHasNoSegments) {
  EXPECT_EQ(refusal_of_change([](ChangeReport&) {}), "accepted");
  for (const ChangeKind kind : {ChangeKind::kNew, ChangeKind::kGone}) {
    EXPECT_THAT(refusal_of_change([&](ChangeReport& c) { c.kind = kind; }),
                HasSubstr("change_report_t.motion_W is a motion, expected the identity"));
  }
  EXPECT_EQ(refusal_of_change([](ChangeReport& c) { c.kind = ChangeKind::kWithdrawn; }),
            "accepted");
  EXPECT_THAT(refusal_of_change([](ChangeReport& c) {
                c.kind = ChangeKind::kGone;
                c.motion_W = Pose::Identity();
              }),
              HasSubstr("num_segments is 2, expected 0, as the object is gone"));
  EXPECT_THAT(refusal_of_change([](ChangeReport& c) { c.kind = ChangeKind{4}; }),
              HasSubstr("kind is 4, expected 0 .. 3"));
  EXPECT_THAT(refusal_of_change([](ChangeReport& c) { c.change = 5; }),
              HasSubstr("change is 5, expected 1 .. 4"));
  EXPECT_THAT(refusal_of_change([](ChangeReport& c) { c.event_number = -1; }),
              HasSubstr("event_number is -1"));
  EXPECT_THAT(refusal_of_change([](ChangeReport& c) { c.motion_W.linear()(0, 0) = 3.0; }),
              AllOf(HasSubstr("motion_W"), HasSubstr("a rotation")));
  EXPECT_THAT(refusal_of_change([](ChangeReport& c) { c.before = "\x1b[2J"; }),
              HasSubstr("before is a text with byte 27"));
  EXPECT_THAT(refusal_of_change([](ChangeReport& c) { c.box_max_W[1] = -9.0F; }),
              HasSubstr("box_max_W is -9, expected at least box_min_W"));
  EXPECT_THAT(refusal_of_change([](ChangeReport& c) {
                c.segment_ids = {4, 3};
              }),
              HasSubstr("segment_ids is 3, expected > 4"));
}

template <class Change>
std::string refusal_of_correction(const Change& change) {
  return refusal(example_correction(3), change);
}

TEST(CodecBounds, ACorrectionHasMotionsThatMoveEachPatchOnceAndNoPoints) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(refusal_of_correction([](CloudSlice&) {}), "accepted");
  EXPECT_THAT(refusal_of_correction([](CloudSlice& s) { s.correction = 0; }),
              HasSubstr("cloud_slice_t.correction is 0, expected > 0"));
  EXPECT_THAT(refusal_of_correction([](CloudSlice& s) { s.revision = 1; }),
              HasSubstr("revision is 1, expected 0, in a correction"));
  EXPECT_THAT(refusal_of_correction([](CloudSlice& s) { s.points_W.resize(2); }),
              HasSubstr("total_points is 2, expected 0, in a correction"));
  EXPECT_THAT(refusal_of_correction([](CloudSlice& s) { s.motions[0].id = -1; }),
              HasSubstr("motion slice_id is -1, expected >= 0"));
  EXPECT_THAT(refusal_of_correction([](CloudSlice& s) { s.motions[1].id = 3; }),
              HasSubstr("motion slice_id is 3, expected >= 4, ascending"));
  EXPECT_THAT(refusal_of_correction([&](CloudSlice& s) { s.motions[2].X_WP.t_WP[1] = nan; }),
              HasSubstr("motion t_WP is nan"));
  EXPECT_THAT(refusal_of_correction([](CloudSlice& s) { s.motions[2].X_WP.t_WP[1] = 2e6F; }),
              HasSubstr("motion t_WP is 2e+06"));
  EXPECT_THAT(refusal_of_correction([&](CloudSlice& s) { s.motions[2].X_WP.q_WP[0] = nan; }),
              HasSubstr("motion q_WP is nan, expected a unit quaternion"));
  EXPECT_THAT(refusal_of_correction([](CloudSlice& s) {
                for (float& q : s.motions[0].X_WP.q_WP) q *= 1.0001F;
              }),
              HasSubstr("motion q_WP is 1.0001, expected a unit quaternion"));
}

TEST(CodecBounds, OnlyACorrectionHasLoops) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THAT(refusal(example_patch(1), [](CloudSlice& s) { s.loops.resize(1); }),
              HasSubstr("total_loops is 1, expected 0, as it is no correction"));
  EXPECT_THAT(refusal_of_correction([](CloudSlice& s) { s.loops[1].later = -1; }),
              HasSubstr("loop later is -1"));
  EXPECT_THAT(refusal_of_correction([&](CloudSlice& s) { s.loops[0].earlier_W[2] = nan; }),
              HasSubstr("loop earlier_W is nan"));
}

TEST(CodecBounds, OnlyPatchesAndCorrectionsMove) {
  EXPECT_EQ(refusal(example_patch(1), [](CloudSlice&) {}), "accepted");
  EXPECT_THAT(refusal(example_slice(1), [](CloudSlice& s) { s.X_WP.t_WP[2] = 0.5F; }),
              HasSubstr("cloud_slice_t.X_WP is a motion, expected the identity"));
  EXPECT_THAT(refusal(example_patch(1), [](CloudSlice& s) { s.X_WP.q_WP[3] = 2.0F; }),
              HasSubstr("cloud_slice_t.q_WP is"));
  EXPECT_THAT(refusal(example_patch(1), [](CloudSlice& s) { s.correction = -1; }),
              HasSubstr("correction is -1, expected >= 0"));
  EXPECT_THAT(refusal(example_patch(1), [](CloudSlice& s) { s.motions.resize(1); }),
              HasSubstr("total_motions is 1, expected 0"));
}

TEST(CodecBounds, AnInvalidFieldIsNamedInTheError) {
  Bytes message = encode(example_camera_pose());
  message[8 + 4 + 24] = 9;  // state: after fingerprint, checksum, utime, session, frame_index
  try {
    (void)decode<CameraPose>(with_checksum(message));
    FAIL() << "accepted";
  } catch (const DecodeError& error) {
    EXPECT_STREQ(error.what(), "camera_pose_t.state is 9, expected 0 .. 3");
  }
}

TEST(CodecBounds, FittingTextMakesAnyTextValid) {
  SegmenterStatus status = example_segmenter_status();
  status.problem = fitting_text("cannot write:\n\tno space" + std::string(2'000, '!'));
  const SegmenterStatus received = decode<SegmenterStatus>(encode(status));
  EXPECT_EQ(received.problem.substr(0, 23), "cannot write:  no space");
  EXPECT_EQ(received.problem.size(), kMaxStringBytes);
}

TEST(CodecBounds, ATruncatedMessageAllocatesNothing) {
  Bytes message = encode_chunk(example_slice(1), 0, 0, kDefaultMaxChunkBytes);
  message.resize(20);
  const std::size_t allocated =
      allocated_by([&] { EXPECT_THROW((void)decode_chunk<CloudSlice>(message), DecodeError); });
  EXPECT_LT(allocated, 4'096U);  // the text of the error
}

}  // namespace
}  // namespace kintsugi
