#include "tests/support/forgeries.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "lcmtypes/channels.hpp"
#include "lcmtypes/codec/codec.hpp"
#include "lcmtypes/statuses.hpp"

namespace kintsugi::testing {
namespace {

constexpr std::size_t kMaxRecorded = 20'000;  // messages
constexpr std::size_t kMaxRecordedBytes = 65'000;
constexpr std::int32_t kRevision = 1'000;  // newer than any that a mapper sends
constexpr std::size_t kKindsOfLies = 10;
constexpr std::size_t kReplayEvery = 4;

/// A wall where there is none.
std::vector<CloudPoint> wall() {
  std::vector<CloudPoint> points;
  for (int i = 0; i < 20; ++i) {
    for (int j = 0; j < 20; ++j) {
      CloudPoint point;
      point.x = 0.01F * static_cast<float>(i);
      point.y = 0.01F * static_cast<float>(j);
      point.nz = 1.0F;
      point.weight = 10.0F;
      points.push_back(point);
    }
  }
  return points;
}

}  // namespace

Forgeries::Forgeries() : other_signer_(std::make_shared<const BusKey>(BusKey::Secret{13})) {}

void Forgeries::learn(const std::string& channel, ByteView data) {
  if (recorded_.size() < kMaxRecorded && data.size() <= kMaxRecordedBytes) {
    recorded_.push_back({channel, {data.begin(), data.end()}});
  }
  const auto parts = signed_message::split(data);
  const ByteView message = parts ? parts->message : data;
  if (parts) {
    const ByteView signature = data.last(signed_message::kSignatureBytes);
    taken_signature_.emplace(signature.begin(), signature.end());
  }
  try {
    if (channel == channels::kCloudSlice) learn_slice(message);
    if (channel == channels::kHeartbeat) learn_heartbeat(message);
  } catch (const DecodeError&) {  // of somebody else
  }
}

void Forgeries::learn_slice(ByteView message) {
  const Chunk<CloudSlice> chunk = decode_chunk<CloudSlice>(message);
  slice_ = chunk.header;
  slice_ids_.push_back(chunk.header.id);
}

void Forgeries::learn_heartbeat(ByteView message) {
  const Heartbeat heartbeat = decode<Heartbeat>(message);
  if (heartbeat.channel == channels::kCloudSlice) {
    next_sequence_ = std::max(next_sequence_, heartbeat.next_sequence);
  }
}

Forgeries::Message Forgeries::next() {
  const std::size_t number = num_made_++;
  if (number % kReplayEvery == kReplayEvery - 1) {
    return recorded_[number / kReplayEvery % recorded_.size()];
  }
  const std::size_t lie_number = num_lies_++;
  Message message = lie(lie_number % kKindsOfLies);
  // Each kind with each signature.
  constexpr std::size_t kNumSignatures = 3;
  const auto signature = static_cast<Signature>(lie_number / kKindsOfLies % kNumSignatures);
  message.data = with_signature(message, signature);
  return message;
}

Bytes Forgeries::with_signature(const Message& message, Signature signature) {
  Bytes data = message.data;
  switch (signature) {
    case Signature::kNone:
      break;
    case Signature::kOtherKey:
      return other_signer_.sign(message.channel, data);
    case Signature::kTaken:
      if (taken_signature_) {
        data.insert(data.end(), taken_signature_->begin(), taken_signature_->end());
      }
      break;
  }
  return data;
}

CloudSlice Forgeries::forged_slice(SliceKind kind) {
  CloudSlice slice = *slice_;
  slice.kind = kind;
  slice.superseded = false;
  slice.ends_batch = true;
  slice.revision = kRevision;
  slice.revision_sum = 0;
  slice.X_WP = {};
  slice.points_W.clear();
  slice.motions.clear();
  slice.loops.clear();
  return slice;
}

/// With the number of a chunk that the mapper has not sent yet: its own will come too late.
Forgeries::Message Forgeries::chunk_of(const CloudSlice& slice) {
  return {channels::kCloudSlice, encode_chunk(slice, next_sequence_++, 0, kDefaultMaxChunkBytes)};
}

Forgeries::Message Forgeries::lie(std::size_t kind) {
  using namespace channels;
  const std::int64_t session = slice_->session;
  const std::string& map_name = slice_->map_name;
  switch (kind) {
    case 0: {
      CloudSlice slice = forged_slice(SliceKind::kPatch);
      slice.id = slice_ids_[num_lies_ % slice_ids_.size()];
      slice.points_W = wall();
      return chunk_of(slice);
    }
    case 1: {
      CloudSlice correction = forged_slice(SliceKind::kCorrection);
      correction.in_volume = false;
      correction.id = *std::ranges::max_element(slice_ids_) + 1;
      correction.revision = 0;
      correction.correction = slice_->correction + 1;
      PatchMotion motion;
      motion.id = slice_ids_.front();
      motion.X_WP.t_WP[0] = 1.0F;
      correction.motions = {motion};
      return chunk_of(correction);
    }
    case 2: {
      CloudSlice end = forged_slice(SliceKind::kFinal);
      end.in_volume = false;
      end.id = *std::ranges::max_element(slice_ids_) + 2;
      end.revision = 0;
      return chunk_of(end);
    }
    case 3: {  // everything up to now is replaced by what comes
      const std::int64_t next = next_sequence_;
      return {kHeartbeat, encode(Heartbeat{1, session, kCloudSlice, next, next, next, map_name})};
    }
    case 4:
      return {kHeartbeat, encode(Heartbeat{1, 1, "MAP_NAME", 0, 0, 0, map_name})};
    case 5:
      return {kResendRequest,
              encode(ResendRequest{1, session, kCloudSlice, kClient, {{0, next_sequence_}}})};
    case 6: {
      SegmentQuery query;
      query.client = kClient;
      query.number = static_cast<std::int64_t>(num_made_);
      query.map_name = map_name;
      query.max_segments = 5;
      return {kSegmentQuery, encode(query)};
    }
    case 7: {
      SegmentUpdate update;
      update.session = std::numeric_limits<std::int64_t>::max() / 2;  // newer than any segmenter
      update.map_session = session;
      update.map_name = map_name;
      update.is_final = true;
      update.num_slices = 1;
      return {kSegmentUpdate, encode_chunk(update, 0, 0, kDefaultMaxChunkBytes)};
    }
    case 8: {
      CameraPose pose;
      pose.session = session;
      return {kCameraPose, encode(pose)};
    }
    default: {
      SegmenterStatus status;
      status.session = 1;
      status.map_session = session;
      status.map_name = map_name;
      status.finished = true;
      return {kSegmenterStatus, encode(status)};
    }
  }
}

}  // namespace kintsugi::testing
