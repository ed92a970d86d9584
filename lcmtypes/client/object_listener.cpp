#include "lcmtypes/client/object_listener.hpp"

#include <utility>

#include "lcmtypes/channels.hpp"

namespace kintsugi {

ObjectListener::ObjectListener(std::string map_name, Handlers handlers)
    : map_name_(std::move(map_name)), handlers_(std::move(handlers)) {}

void ObjectListener::subscribe(Bus& bus, const std::function<double()>& now_s) {
  for (const char* channel :
       {channels::kObjectDetection, channels::kChangeReport, channels::kDetectorStatus}) {
    bus.subscribe(channel,
                  [this, channel, now_s](ByteView message) { handle(channel, message, now_s()); });
  }
}

void ObjectListener::handle(const std::string& channel, ByteView message, double now_s) {
  try {
    if (channel == channels::kObjectDetection) use(decode<ObjectDetection>(message), now_s);
    if (channel == channels::kChangeReport) use(decode<ChangeReport>(message), now_s);
    if (channel == channels::kDetectorStatus) use(decode<DetectorStatus>(message), now_s);
  } catch (const DecodeError& reason) {
    dropped_ = "messages of objects dropped: " + std::to_string(++num_bad_) +
               ", the last: " + reason.what();
  }
}

bool ObjectListener::is_followed(const std::string& map_name) {
  if (map_name_.empty()) map_name_ = map_name;
  return map_name == map_name_;
}

void ObjectListener::use(const ObjectDetection& detection, double now_s) {
  if (!is_followed(detection.map_name)) return;
  if (objects_.apply(detection, now_s) && handlers_.on_detection) {
    handlers_.on_detection(detection);
  }
}

void ObjectListener::use(const ChangeReport& change, double now_s) {
  if (!is_followed(change.map_name)) return;
  if (changes_.apply(change, now_s) && handlers_.on_change) handlers_.on_change(change);
}

void ObjectListener::use(const DetectorStatus& status, double now_s) {
  // A detector that has no map yet has no map name.
  if (status.map_session != 0) {
    if (!is_followed(status.map_name)) return;
    objects_.hear_sender(status.map_session, status.session, now_s);
  }
  detector_ = status;
}

std::string ObjectListener::losses() const {
  std::string text;
  const auto add = [&text](std::int64_t count, const char* what) {
    if (count == 0) return;
    text += (text.empty() ? "" : ", ") + std::to_string(count) + " events of " + what;
  };
  add(objects_.num_lost(), "detections");
  add(changes_.num_lost(), "changes");
  return text.empty() ? text : text + " were not heard; what is known now is complete without them";
}

}  // namespace kintsugi
