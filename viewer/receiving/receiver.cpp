#include "viewer/receiving/receiver.hpp"

#include <utility>

#include "lcmtypes/channels.hpp"

namespace kintsugi::viewer {

template <class Bulk>
StreamSubscriberConfig<Bulk> Receiver::stream_config(const Config& config) const {
  StreamSubscriberConfig<Bulk> stream;
  stream.receiver = config.receiver;
  stream.max_request_bytes = config.max_request_bytes;
  if (kIsResent<Bulk>) stream.max_pending_bytes = config.max_pending_bytes;
  if (config.has_room) {
    stream.room = [has_room = config.has_room] {
      return has_room() ? StreamRoom::kPlenty : StreamRoom::kNone;
    };
  }
  return stream;
}

namespace {

StreamSubscriberConfig<CloudSlice> of_map(StreamSubscriberConfig<CloudSlice> stream,
                                          MapChoice& choice, const std::string& map_name) {
  stream.wanted = [&choice](const CloudSlice& header) { return choice.is_drawn(header.map_name); };
  stream.wanted_map_name = map_name;
  return stream;
}

}  // namespace

Receiver::Receiver(const Config& config, OnMessage on_message, OnBad on_bad)
    : on_message_(std::move(on_message)),
      on_bad_(std::move(on_bad)),
      choice_(config.map_name),
      slices_(
          channels::kCloudSlice,
          [this](CloudSlice slice) {
            if (!slice.superseded) on_message_(std::move(slice));
          },
          [this](const DecodeError& reason) { bad(reason); },
          of_map(stream_config<CloudSlice>(config), choice_, config.map_name)),
      updates_(
          channels::kSegmentUpdate, [this](SegmentUpdate update) { use(std::move(update)); },
          [this](const DecodeError& reason) { bad(reason); }, stream_config<SegmentUpdate>(config)),
      views_(
          channels::kCameraView,
          [this](CameraView view) {
            if (choice_.is_drawn(view.map_name)) on_message_(std::move(view));
          },
          [this](const DecodeError& reason) { bad(reason); }, stream_config<CameraView>(config)),
      answers_(
          channels::kSegmentAnswer,
          [this](SegmentAnswer answer) { on_message_(std::move(answer)); },
          [this](const DecodeError& reason) { bad(reason); },
          stream_config<SegmentAnswer>(config)) {}

/// Updates of several maps may share one stream, so the stream itself cannot be filtered.
void Receiver::use(SegmentUpdate update) {
  if (!choice_.is_drawn(update.map_name)) return;
  if (update.session > segmenter_session_) {
    // The segmenter was restarted: do not request updates of its earlier session.
    if (segmenter_session_ != 0) updates_.forget(segmenter_session_);
    segmenter_session_ = update.session;
  }
  on_message_(std::move(update));
}

void Receiver::subscribe(Bus& bus) {
  slices_.subscribe(bus);
  updates_.subscribe(bus);
  views_.subscribe(bus);
  answers_.subscribe(bus);
  bus.subscribe(channels::kCameraPose, [this](ByteView data) { handle_small<CameraPose>(data); });
  bus.subscribe(channels::kSegmenterStatus,
                [this](ByteView data) { handle_small<SegmenterStatus>(data); });
  bus.subscribe(channels::kObjectDetection,
                [this](ByteView data) { handle_small<ObjectDetection>(data); });
  bus.subscribe(channels::kDetectorStatus,
                [this](ByteView data) { handle_small<DetectorStatus>(data); });
}

void Receiver::request_missing(Bus& bus, double now_s) {
  slices_.ask(bus, now_s);
  updates_.ask(bus, now_s);
}

void Receiver::handle(const std::string& channel, ByteView data) {
  slices_.handle(channel, data);
  updates_.handle(channel, data);
  views_.handle(channel, data);
  answers_.handle(channel, data);
  if (channel == channels::kCameraPose) handle_small<CameraPose>(data);
  if (channel == channels::kSegmenterStatus) handle_small<SegmenterStatus>(data);
  if (channel == channels::kObjectDetection) handle_small<ObjectDetection>(data);
  if (channel == channels::kDetectorStatus) handle_small<DetectorStatus>(data);
}

template <SmallMessage Small>
void Receiver::handle_small(ByteView data) {
  Small message;
  try {
    message = decode<Small>(data);
  } catch (const DecodeError& reason) {
    bad(reason);
    return;
  }
  on_message_(std::move(message));
}

void Receiver::bad(const DecodeError& reason) { on_bad_(++bad_, reason.what()); }

bool Receiver::may_still_come() const {
  const auto may_come = [](const StreamCounts& counts) {
    return counts.chunks_missing > counts.chunks_given_up;
  };
  return may_come(slices_.counts()) || may_come(updates_.counts());
}

void Receiver::add_to(ViewerStatus& status) const {
  for (const StreamCounts& counts : {slices_.counts(), updates_.counts()}) {
    status.chunks_missing += counts.chunks_missing;
    status.chunks_refused += counts.chunks_refused;
    status.chunks_given_up += counts.chunks_given_up;
    status.requests_sent += counts.requests_sent;
  }
  status.queue_bytes +=
      static_cast<std::int64_t>(slices_.pending_bytes() + updates_.pending_bytes());
  status.messages_bad = bad_;
  report_refused(status);
  if (status.problem.empty()) status.problem = choice_.problem();
}

}  // namespace kintsugi::viewer
