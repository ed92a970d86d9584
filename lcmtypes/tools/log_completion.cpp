#include "lcmtypes/tools/log_completion.hpp"

#include <utility>

#include "lcmtypes/channels.hpp"

namespace kintsugi {
namespace {

template <BulkMessage Message>
StreamSubscriberConfig<Message> of_this_process() {
  StreamSubscriberConfig<Message> config;
  config.receiver = new_session();
  return config;
}

}  // namespace

LogCompletion::LogCompletion(const std::filesystem::path& log)
    : log_(log),
      slices_(
          channels::kCloudSlice, [](const CloudSlice&) {}, {}, of_this_process<CloudSlice>()),
      updates_(
          channels::kSegmentUpdate, [this](const SegmentUpdate& update) { use(update); }, {},
          of_this_process<SegmentUpdate>()),
      keyframes_(
          channels::kKeyframe, [](const KeyframeMessage&) {}, {},
          of_this_process<KeyframeMessage>()) {}

/// A segmenter that was started again begins with the whole map: what its earlier session has sent
/// is not needed any more, and nobody sends it again.
void LogCompletion::use(const SegmentUpdate& update) {
  const auto [known, is_new] = segmenters_.try_emplace(update.map_session, update.session);
  if (is_new || known->second >= update.session) return;
  updates_.forget(std::exchange(known->second, update.session));
}

void LogCompletion::read_on() {
  log_.go_on();
  while (const auto event = log_.next()) {
    slices_.handle(event->channel, event->data);
    updates_.handle(event->channel, event->data);
    keyframes_.handle(event->channel, event->data);
  }
}

void LogCompletion::ask(Bus& bus, double now_s) {
  slices_.ask(bus, now_s);
  updates_.ask(bus, now_s);
  keyframes_.ask(bus, now_s);
}

LogCompletion::Missing LogCompletion::missing() const {
  Missing missing;
  for (const StreamCounts& counts : {slices_.counts(), updates_.counts(), keyframes_.counts()}) {
    missing.chunks += counts.chunks_missing;
    missing.given_up += counts.chunks_given_up;
  }
  return missing;
}

std::string LogCompletion::damage() const {
  return log_.is_cut_off() ? "" : log_.damage().value_or("");
}

}  // namespace kintsugi
