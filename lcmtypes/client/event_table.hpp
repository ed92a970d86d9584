#pragma once
// The detections of objects, and the changes against another map, as a client knows them.

#include <cstddef>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "lcmtypes/messages.hpp"
#include "lcmtypes/sequence_set.hpp"

namespace kintsugi {

/// The object is in the map, as far as the detector knows.
inline bool is_present(const ObjectDetection& detection) {
  return detection.event != DetectionEvent::kGone;
}
/// What is reported is so.
inline bool is_present(const ChangeReport& change) { return change.kind != ChangeKind::kWithdrawn; }

/// The newest message of each detection (or change) of one map. Its sender repeats each about once
/// a second, so that messages may be lost, come in another order, and several times.
///
/// - Of one detection the message with the highest event_number counts, and of those with the same
///   number the newest.
/// - The caller passes messages of one map only. The table has the newest session of it: a message
///   of a newer session of the mapper or the sender clears the table first, one of an older session
///   is ignored.
/// - A detection that is not repeated for kSilence_s while its sender is heard is dropped, at most
/// a second
///   later.
///
/// `now_s` is the time of a clock of the caller that never goes back.
template <class Message>
class EventTable {
 public:
  static constexpr double kSilence_s = 10.0;
  /// Who listens for so long has heard every message that is repeated. What is then the newest
  /// event happened before; later ones that are not heard are lost.
  static constexpr double kJoining_s = 1.5;
  /// Further ones are ignored, so that a hostile sender cannot fill the memory.
  static constexpr std::size_t kMaxEntries = 65'536;

  struct Entry {
    Message message;
    double heard_s = 0.0;
  };

  /// Applies a message. True if it tells an event that was not heard before.
  bool apply(const Message& message, double now_s);
  /// The sender says that it runs, for instance with its status.
  void hear_sender(std::int64_t map_session, std::int64_t session, double now_s);

  /// By ascending number.
  const std::map<std::int32_t, Entry>& entries() const { return entries_; }
  /// Those that are present, by ascending number.
  std::vector<Message> present() const;

  /// Of the mapper and the sender whose messages these are; 0: none was heard.
  std::int64_t map_session() const { return sessions_.first; }
  std::int64_t session() const { return sessions_.second; }
  /// As its sender says, of which some may not be heard yet.
  std::int32_t num_numbered() const { return num_numbered_; }
  /// Events since the caller joined that were not heard: lost, or not repeated yet.
  std::int64_t num_lost() const { return heard_.count_missing(joined_ + 1, newest_ + 1); }

 private:
  using Sessions = std::pair<std::int64_t, std::int64_t>;

  bool is_of_session(const Sessions& sessions, double now_s);
  void keep(const Message& message, double now_s);
  void drop_silent(double now_s);
  bool note_event(std::int64_t event_number, double now_s);

  Sessions sessions_{0, 0};
  double dropped_s_ = 0.0;   // when drop_silent() last looked at all entries
  double started_s_ = 0.0;   // when its first message was heard
  std::int64_t newest_ = 0;  // event number
  std::int64_t joined_ = 0;  // the newest event number when the caller joined
  std::int32_t num_numbered_ = 0;
  SequenceSet heard_;  // event numbers
  std::map<std::int32_t, Entry> entries_;
};

using ObjectTable = EventTable<ObjectDetection>;
using ChangeTable = EventTable<ChangeReport>;

}  // namespace kintsugi
