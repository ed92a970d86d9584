#pragma once
// What a log of the bus lacks, while it is written.

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>

#include "lcmtypes/bus/bus.hpp"
#include "lcmtypes/log/log_reader.hpp"
#include "lcmtypes/stream/stream_subscriber.hpp"

namespace kintsugi {

/// Reads a log as lcm-logger writes it, and requests the chunks that it lacks of the streams of
/// which the senders keep what they have sent. lcm-logger itself asks for nothing: it drops what it
/// has no time for. What is sent again it hears like everything else.
class LogCompletion {
 public:
  /// @throws std::runtime_error as LogReader
  explicit LogCompletion(const std::filesystem::path& log);

  /// Takes what has been appended since.
  void read_on();
  /// Requests what is missing. @param now_s time of a PatientClock
  void ask(Bus& bus, double now_s);

  struct Missing {
    std::int64_t chunks = 0;    ///< that were sent and are not in the log
    std::int64_t given_up = 0;  ///< of these: nobody sends them again
  };
  [[nodiscard]] Missing missing() const;
  /// Where and how the log is damaged, other than that its last event is not written yet; empty: it
  /// is not.
  [[nodiscard]] std::string damage() const;

 private:
  void use(const SegmentUpdate& update);

  LogReader log_;
  StreamSubscriber<CloudSlice> slices_;
  StreamSubscriber<SegmentUpdate> updates_;
  StreamSubscriber<KeyframeMessage> keyframes_;
  std::map<std::int64_t, std::int64_t> segmenters_;  // their newest session, by that of the map
};

}  // namespace kintsugi
