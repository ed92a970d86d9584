// Messages and logs of them.

#include "lcmtypes/channels.hpp"
#include "lcmtypes/log/session_log.hpp"
#include "mapper/session/chunk_fates.hpp"
#include "mapper/session/mapped_frames.hpp"
#include "mapper/session/stored_sessions.hpp"
#include "tests/decoder_fuzz/log_events.hpp"
#include "tests/decoder_fuzz/seeds.hpp"
#include "tests/decoder_fuzz/signed_key.hpp"
#include "tests/support/example_messages.hpp"

namespace kintsugi::fuzzing {
namespace {

template <BulkMessage Message>
void append_chunks(const char* channel, const Message& message, std::int64_t first_sequence,
                   std::vector<LoggedMessage>& events) {
  const std::int32_t count = num_chunks(message, kMinMaxChunkBytes);
  for (std::int32_t i = 0; i < count; ++i) {
    events.push_back({channel, encode_chunk(message, first_sequence + i, i, kMinMaxChunkBytes)});
  }
}

template <BulkMessage Message>
Bytes log_of(const char* channel, const Message& first, const Message& second) {
  std::vector<LoggedMessage> events;
  append_chunks(channel, first, 0, events);
  Heartbeat heartbeat = testing::example_heartbeat();
  heartbeat.session = first.session;
  heartbeat.channel = channel;
  events.push_back({channels::kHeartbeat, encode(heartbeat)});
  ChunksReplaced replaced = testing::example_chunks_replaced();
  replaced.session = first.session;
  replaced.channel = channel;
  events.push_back({channels::kChunksReplaced, encode(replaced)});
  append_chunks(channel, second, static_cast<std::int64_t>(events.size()), events);
  return write_events(events);
}

}  // namespace

Seeds message_seeds() {
  using namespace testing;  // NOLINT(google-build-using-namespace): the examples
  return {{"camera_pose", encode(example_camera_pose())},
          {"mapper_status", encode(example_mapper_status())},
          {"segmenter_status", encode(example_segmenter_status())},
          {"viewer_status", encode(example_viewer_status())},
          {"detector_status", encode(example_detector_status())},
          {"object_detection", encode(example_detection())},
          {"change_report", encode(example_change())},
          {"heartbeat", encode(example_heartbeat())},
          {"resend_request", encode(example_resend_request())},
          {"chunks_replaced", encode(example_chunks_replaced())},
          {"cloud_slice", encode_chunk(example_slice(10), 0, 0, kDefaultMaxChunkBytes)},
          {"patch", encode_chunk(example_patch(5), 0, 0, kDefaultMaxChunkBytes)},
          {"correction", encode_chunk(example_correction(6), 0, 0, kDefaultMaxChunkBytes)},
          {"segment_update", encode_chunk(example_update(12), 0, 0, kDefaultMaxChunkBytes)},
          {"segment_query", encode(example_query())},
          {"segment_answer", encode_chunk(example_answer(3), 0, 0, kDefaultMaxChunkBytes)},
          {"rgbd_frame", encode_chunk(example_frame(40, 30), 0, 0, kDefaultMaxChunkBytes)},
          {"view", encode_chunk(example_view(50), 0, 0, kDefaultMaxChunkBytes)},
          {"snapshot", encode_chunk(example_snapshot(50), 0, 0, kDefaultMaxChunkBytes)}};
}

Seeds signed_message_seeds() {
  const auto signed_one = [](std::uint64_t session, std::int64_t sequence, const Bytes& message) {
    return signed_message::sign(signed_key(), kSignedChannel, session, sequence, message);
  };
  const Bytes pose = encode(testing::example_camera_pose());
  return {{"unsigned", pose},
          {"signed", signed_one(signed_message::new_session(), 1, pose)},
          {"empty", signed_one(std::uint64_t{1} << 32U, 2, {})}};
}

Seeds log_seeds() {
  using namespace testing;  // NOLINT(google-build-using-namespace): the examples
  return {
      {"slices", log_of(channels::kCloudSlice, example_slice(90, 0), example_slice(50, 1))},
      {"corrections",
       log_of(channels::kCloudSlice, example_correction(90, 0), example_correction(50, 1))},
      {"updates", log_of(channels::kSegmentUpdate, example_update(200, 0), example_update(9, 1))},
      {"answers", log_of(channels::kSegmentAnswer, example_answer(20), example_answer(0))},
      {"frames", log_of(channels::kRgbdFrame, example_frame(1'500, 900), example_frame(40, 0))},
      {"keyframes", log_of(channels::kKeyframe, example_keyframe(90), example_keyframe(0))},
      {"views", log_of(channels::kCameraView, example_view(3'000), example_view(0))},
      {"pictures", log_of(channels::kSnapshot, example_snapshot(3'000), example_snapshot(50))}};
}

Seeds request_seeds() {
  ResendRequest request = testing::example_resend_request();
  const Bytes first = encode(request);
  request.ranges = {{4, 11}, {8, 20}, {38, kMaxSequence}};
  return {
      {"requests", write_events({{channels::kResendRequest, first},
                                 {channels::kResendRequest, encode(request)},
                                 {channels::kHeartbeat, encode(testing::example_heartbeat())}})}};
}

Seeds stored_session_seeds() {
  CloudSlice slice = testing::example_slice(60, 0);
  slice.kind = SliceKind::kFinal;
  MapperStatus status = testing::example_mapper_status();
  status.session = slice.session;
  std::vector<LoggedMessage> events = {
      {kOptionsChannel, mapper::encode_options(slice.session, {{"resolution", "0.01"}})},
      {channels::kMapperStatus, encode(status)},
      {channels::kCameraPose, encode(testing::example_camera_pose())}};
  append_chunks(channels::kCloudSlice, slice, 0, events);
  RgbdFrameMessage frame = testing::example_frame(40, 30);
  frame.session = slice.session;
  append_chunks(channels::kRgbdFrame, frame, 0, events);
  std::vector<LoggedMessage> rewritten = {
      events.front(),
      {mapper::kMappedFramesChannel,
       mapper::encode_mapped_frames(slice.session, std::vector<std::int64_t>{5, 33'005, 70'000})},
      {mapper::kTrackedOnlyChannel,
       mapper::encode_mapped_frames(slice.session, std::vector<std::int64_t>{33'005})}};
  mapper::ChunkFates fates;
  fates.replaced.insert({2, 5});
  fates.superseded.insert({4, 5});
  fates.changed.insert({2, 3});
  for (const auto& [channel, data] :
       mapper::encode_fates({channels::kCloudSlice, slice.session, fates}, slice.map_name)) {
    rewritten.push_back({channel, data});
  }
  append_chunks(channels::kCloudSlice, slice, 0, rewritten);
  return {{"session", write_events(events)}, {"rewritten", write_events(rewritten)}};
}

Seeds rgbd_frame_seeds() {
  Seeds seeds;
  for (const auto& [name, image] : image_seeds()) {
    if (!name.starts_with("color")) continue;
    RgbdFrameMessage frame = testing::example_frame(1, 0);
    frame.intrinsics.width = 8;
    frame.intrinsics.height = 6;
    frame.depth_png = image_seeds().at("depth_png");
    frame.color_jpeg = image;
    std::vector<LoggedMessage> events;
    append_chunks(channels::kRgbdFrame, frame, 0, events);
    seeds[name] = write_events(events);
  }
  return seeds;
}

}  // namespace kintsugi::fuzzing
