#pragma once
// A client of the segmenter: receives the segment table of one map, from the bus or a log.

#include <functional>
#include <string>

#include "lcmtypes/client/segment_table.hpp"
#include "lcmtypes/stream/stream_subscriber.hpp"

namespace kintsugi {

/// Keeps the segment table of one map up to date, and requests updates that were lost. Only one
/// thread may use it.
///
/// On the bus, a listener that joins late receives a full state from the segmenter. A log has only
/// the updates that were recorded.
class SegmentListener {
 public:
  /// @param map_name empty: the map of the first update that is received
  /// @param on_update called with each update after it was applied to the table, in the order in
  /// which
  ///   the updates are complete; after losses this is not the order of their sequence numbers
  SegmentListener(const std::string& map_name,
                  std::function<void(const SegmentUpdate& update)> on_update);
  SegmentListener(const SegmentListener&) = delete;  // the subscriber calls it
  SegmentListener& operator=(const SegmentListener&) = delete;

  /// From now on bus.handle() applies updates. This must outlive the last bus.handle().
  void subscribe(Bus& bus) { updates_.subscribe(bus); }
  /// Requests what is missing. To be called regularly; `now_s` is the time of a PatientClock.
  void ask(Bus& bus, double now_s) { updates_.ask(bus, now_s); }
  /// Handles one LCM message of a log.
  void handle(const std::string& channel, ByteView message) { updates_.handle(channel, message); }

  const SegmentTable& table() const { return table_; }
  /// The table has every segment of the map as far as it was published.
  bool is_whole() const { return problem().empty(); }
  /// What is missing, as text for a person; empty: nothing.
  std::string problem() const;
  /// The map is complete, and the table is whole or the segmenter does not send what is missing.
  bool has_ended() const;
  /// How many messages were dropped as invalid, and why the last was; empty: none.
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
