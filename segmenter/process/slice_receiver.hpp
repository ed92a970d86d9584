#pragma once
// From the bus, or a log, to whole slices.

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <thread>

#include "lcmtypes/bus/bus.hpp"
#include "lcmtypes/stream/stream_subscriber.hpp"
#include "segmenter/map/segment_map.hpp"
#include "segmenter/process/slice_queue.hpp"

namespace kintsugi::segmenter {

/// Decodes and joins chunks, asks for what is missing, and puts slices into a queue while that has
/// room. Messages that cannot be used are counted, and told of ever more rarely.
class SliceReceiver {
 public:
  struct Config {
    std::int64_t session = 0;                               ///< of this segmenter: who asks
    std::string map_name;                                   ///< only slices of this map; empty: all
    std::size_t max_pending_bytes = std::size_t{1} << 30U;  ///< of incomplete slices
  };

  /// `queue` must outlive this.
  SliceReceiver(const Config& config, SliceQueue& queue);
  /// Stops reading.
  ~SliceReceiver();
  SliceReceiver(const SliceReceiver&) = delete;
  SliceReceiver& operator=(const SliceReceiver&) = delete;

  /// From now on bus.handle() fills the queue; this must outlive that.
  void subscribe(Bus& bus);
  /// Asks for what is missing, when it is time to; for the thread of bus.handle().
  void ask(Bus& bus, double now_s);

  /// Reads `log` in a thread of its own, as fast as there is room, and then closes the queue.
  /// Throws std::runtime_error when it is no log.
  void read(const std::filesystem::path& log);

  /// Takes no more; of a log: reads no further. Call before problem().
  void stop();

  // What is known of a session; from any thread.
  /// What is missing of it is on its way. Not of a log.
  [[nodiscard]] bool is_coming(std::int64_t map_session) const;
  /// What is in a map that is gone on with need not come again.
  void restore(const SegmentMap& map) {
    subscriber_.restore(map.map_session(), map.chunks().ranges());
  }
  void forget(std::int64_t map_session) { subscriber_.forget(map_session); }
  [[nodiscard]] StreamCounts counts() const { return subscriber_.counts(); }
  [[nodiscard]] std::size_t pending_bytes() const { return subscriber_.pending_bytes(); }

  /// Why the log could not be read to its end; nothing when it could.
  [[nodiscard]] const std::optional<std::string>& problem() const { return problem_; }

 private:
  void bad(const DecodeError& reason);

  SliceQueue& queue_;
  std::atomic<bool> stopping_{false};
  std::int64_t num_bad_ = 0;            // of the thread that receives
  std::optional<std::string> problem_;  // of the reader, until it is stopped
  StreamSubscriber<CloudSlice> subscriber_;
  std::thread reader_;
};

}  // namespace kintsugi::segmenter
