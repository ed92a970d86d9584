#include "lcmtypes/client/event_table.hpp"

#include <algorithm>

namespace kintsugi {
namespace {

std::int32_t number_of(const ObjectDetection& detection) { return detection.detection; }
std::int32_t number_of(const ChangeReport& change) { return change.change; }
std::int32_t count_in(const ObjectDetection& detection) { return detection.num_detections; }
std::int32_t count_in(const ChangeReport& change) { return change.num_changes; }

}  // namespace

template <class Message>
bool EventTable<Message>::is_of_session(const Sessions& sessions, double now_s) {
  if (sessions > sessions_) {
    *this = EventTable();
    sessions_ = sessions;
    started_s_ = now_s;
  }
  return sessions == sessions_;
}

template <class Message>
bool EventTable<Message>::apply(const Message& message, double now_s) {
  if (!is_of_session({message.map_session, message.session}, now_s)) return false;
  num_numbered_ = std::max(num_numbered_, count_in(message));
  keep(message, now_s);
  drop_silent(now_s);
  return note_event(message.event_number, now_s);
}

template <class Message>
void EventTable<Message>::keep(const Message& message, double now_s) {
  const auto found = entries_.find(number_of(message));
  if (found == entries_.end()) {
    if (entries_.size() < kMaxEntries) entries_.emplace(number_of(message), Entry{message, now_s});
    return;
  }
  Entry& entry = found->second;
  entry.heard_s = now_s;
  const auto age = [](const Message& m) { return std::pair(m.event_number, m.utime); };
  if (age(message) >= age(entry.message)) entry.message = message;
}

template <class Message>
bool EventTable<Message>::note_event(std::int64_t event_number, double now_s) {
  newest_ = std::max(newest_, event_number);
  if (now_s - started_s_ <= kJoining_s) joined_ = newest_;
  return heard_.num_ranges() < kMaxEntries && heard_.insert(event_number);
}

template <class Message>
void EventTable<Message>::hear_sender(std::int64_t map_session, std::int64_t session,
                                      double now_s) {
  if (!is_of_session({map_session, session}, now_s)) return;
  drop_silent(now_s);
}

template <class Message>
void EventTable<Message>::drop_silent(double now_s) {
  if (now_s - dropped_s_ < 1.0) return;  // looking at all entries takes time
  dropped_s_ = now_s;
  std::erase_if(entries_,
                [&](const auto& entry) { return now_s - entry.second.heard_s > kSilence_s; });
}

template <class Message>
std::vector<Message> EventTable<Message>::present() const {
  std::vector<Message> messages;
  for (const auto& [number, entry] : entries_) {
    if (is_present(entry.message)) messages.push_back(entry.message);
  }
  return messages;
}

template class EventTable<ObjectDetection>;
template class EventTable<ChangeReport>;

}  // namespace kintsugi
