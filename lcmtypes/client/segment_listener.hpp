#pragma once
// A client of the segmenter: the segment table of one map, from the bus or a log.

#include <functional>
#include <string>

#include "lcmtypes/client/segment_table.hpp"
#include "lcmtypes/stream/stream_subscriber.hpp"

namespace kintsugi {

/// Keeps the table of one map, asking for updates that were lost; belongs to one thread.
///
/// Who begins late is given a full state while the segmenter is there; a log has only what was
/// recorded.
class SegmentListener {
 public:
  /// `on_update` gets each update that the table has taken over, in the order in which their last
  /// chunks arrive: after losses not quite that of their sequence numbers.
  /// @param map_name empty: the map that is heard of first
  SegmentListener(const std::string& map_name,
                  std::function<void(const SegmentUpdate& update)> on_update);
  SegmentListener(const SegmentListener&) = delete;  // the subscriber calls it
  SegmentListener& operator=(const SegmentListener&) = delete;

  /// From now on bus.handle() brings updates; this must outlive that.
  void subscribe(Bus& bus) { updates_.subscribe(bus); }
  /// Asks for what is missing; `now_s` is a PatientClock's.
  void ask(Bus& bus, double now_s) { updates_.ask(bus, now_s); }
  /// One LCM message, of a log.
  void handle(const std::string& channel, ByteView message) { updates_.handle(channel, message); }

  const SegmentTable& table() const { return table_; }
  /// Nothing is missing that the table would need.
  bool is_whole() const { return problem().empty(); }
  /// What is missing; empty: nothing.
  std::string problem() const;
  /// The map is complete, and so is the table, or nobody gives what is missing.
  bool has_ended() const;
  /// Messages that were dropped, and why the last was; empty: none.
  const std::string& dropped() const { return dropped_; }

 private:
  void use(const SegmentUpdate& update);
  void note_bad(const DecodeError& reason);
  bool lacks_updates() const;

  std::string map_name_;
  const std::function<void(const SegmentUpdate&)> on_update_;
  SegmentTable table_;
  std::int64_t num_bad_ = 0;
  std::string dropped_;
  StreamSubscriber<SegmentUpdate> updates_;
};

}  // namespace kintsugi
