#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "lcmtypes/codec/codec.hpp"
#include "tests/support/example_messages.hpp"
#include "tests/support/message_equality.hpp"

namespace kintsugi {
namespace {

using namespace testing;  // NOLINT: the examples

template <SmallMessage Message>
Message through_the_wire(const Message& message) {
  return decode<Message>(encode(message));
}

template <BulkMessage Message>
std::vector<Chunk<Message>> chunks_of(const Message& message, std::size_t max_chunk_bytes) {
  std::vector<Chunk<Message>> chunks;
  const std::int32_t count = num_chunks(message, max_chunk_bytes);
  for (std::int32_t index = 0; index < count; ++index) {
    const Bytes data = encode_chunk(message, 1000 + index, index, max_chunk_bytes);
    EXPECT_LE(data.size(), max_chunk_bytes);
    chunks.push_back(decode_chunk<Message>(data));
  }
  return chunks;
}

template <BulkMessage Message>
void expect_round_trip(const Message& message) {
  for (const std::size_t limit : {kMinMaxChunkBytes, std::size_t{2'003}, kDefaultMaxChunkBytes}) {
    const auto chunks = chunks_of(message, limit);
    EXPECT_TRUE(join(chunks) == message) << chunks.size() << " chunks";
    for (const auto& chunk : chunks) {
      EXPECT_EQ(chunk.sequence, 1000 + chunk.index);
      EXPECT_EQ(chunk.count, static_cast<std::int32_t>(chunks.size()));
    }
  }
}

TEST(CodecRoundTrip, SmallMessagesKeepEveryField) {
  EXPECT_TRUE(through_the_wire(example_camera_pose()) == example_camera_pose());
  EXPECT_TRUE(through_the_wire(example_mapper_status()) == example_mapper_status());
  EXPECT_TRUE(through_the_wire(example_segmenter_status()) == example_segmenter_status());
  EXPECT_TRUE(through_the_wire(example_viewer_status()) == example_viewer_status());
  EXPECT_TRUE(through_the_wire(example_heartbeat()) == example_heartbeat());
  EXPECT_TRUE(through_the_wire(example_resend_request()) == example_resend_request());
  EXPECT_TRUE(through_the_wire(example_chunks_replaced()) == example_chunks_replaced());
  EXPECT_TRUE(through_the_wire(example_query()) == example_query());
  EXPECT_TRUE(through_the_wire(example_detector_status()) == example_detector_status());
  EXPECT_TRUE(through_the_wire(example_detection()) == example_detection());
  EXPECT_TRUE(through_the_wire(example_change()) == example_change());
}

TEST(CodecRoundTrip, BulkMessagesKeepEveryFieldWhateverTheChunkSize) {
  expect_round_trip(example_slice(0));
  expect_round_trip(example_slice(1));
  expect_round_trip(example_slice(5'000));
  expect_round_trip(example_patch(0));
  expect_round_trip(example_patch(301));
  expect_round_trip(example_correction(0));
  expect_round_trip(example_correction(1));
  expect_round_trip(example_correction(5'000));
  expect_round_trip(example_update(0));
  expect_round_trip(example_update(3'001));
  expect_round_trip(example_answer(0));
  expect_round_trip(example_answer(1));
  expect_round_trip(example_answer(901));
  expect_round_trip(example_frame(10'001, 0));
  expect_round_trip(example_frame(1, 70'003));
  expect_round_trip(example_keyframe(0));
  expect_round_trip(example_keyframe(500));
  expect_round_trip(example_view(0));
  expect_round_trip(example_view(123'457));
  expect_round_trip(example_snapshot(123'457));
}

TEST(CodecRoundTrip, AnUpdateHasTheSequenceNumberOfItsFirstChunk) {
  EXPECT_EQ(join(chunks_of(example_update(5'000), 10'000)).sequence, 1000);
}

TEST(CodecRoundTrip, LongestNamesLeaveRoomForAPayloadInTheSmallestChunk) {
  CloudSlice slice = example_slice(20);
  slice.map_name = std::string(kMaxStringBytes, 'x');
  expect_round_trip(slice);
  SegmentUpdate update = example_update(20);
  update.map_name = slice.map_name;
  expect_round_trip(update);
  SegmentAnswer answer = example_answer(0);
  answer.map_name = slice.map_name;
  answer.problem = slice.map_name;
  expect_round_trip(answer);
  KeyframeMessage keyframe = example_keyframe(20);
  keyframe.map_name = keyframe.join = std::string(kMaxJoinNameBytes, 'x');
  expect_round_trip(keyframe);
}

TEST(CodecRoundTrip, PointsMayHaveAnyValue) {
  CloudSlice slice = example_slice(2);
  slice.points_W[0].x = std::numeric_limits<float>::infinity();
  slice.points_W[1].nz = -std::numeric_limits<float>::infinity();
  expect_round_trip(slice);
}

TEST(CodecRoundTrip, SliceChunksHoldWholePointsAndTheirPlace) {
  const CloudSlice slice = example_slice(5'000);
  for (const auto& chunk : chunks_of(slice, 10'000)) {
    EXPECT_EQ(chunk.num_records[0], 5'000);
    EXPECT_EQ(chunk.total_bytes, 160'000);
    ASSERT_EQ(chunk.first_byte % 32, 0);
    ASSERT_EQ(chunk.part.size() % 32, 0U);
    CloudPoint first;
    std::memcpy(&first, chunk.part.data(), sizeof(first));
    EXPECT_EQ(first, slice.points_W.at(static_cast<std::size_t>(chunk.first_byte / 32)));
  }
}

TEST(CodecRoundTrip, JoinRefusesChunksThatDoNotFitTogether) {
  const auto whole = chunks_of(example_slice(5'000), 10'000);
  auto lost = whole;
  lost.pop_back();
  EXPECT_THROW(join(lost), DecodeError);
  auto swapped = whole;
  std::swap(swapped[0], swapped[1]);
  EXPECT_THROW(join(swapped), DecodeError);
  auto mixed = whole;
  mixed[1] = chunks_of(example_slice(5'000, 8), 10'000)[1];
  EXPECT_THROW(join(mixed), DecodeError);
  EXPECT_THROW(join(std::vector<Chunk<CloudSlice>>{}), DecodeError);
}

}  // namespace
}  // namespace kintsugi
