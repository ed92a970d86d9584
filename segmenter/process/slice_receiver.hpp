#pragma once
// Receives whole slices from the bus or from a log.

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
#include "segmenter/process/view_recorder.hpp"

namespace kintsugi::segmenter {

/// Decodes messages, joins chunks to slices, requests what is missing, and puts slices into a queue
/// while that has room. Messages that cannot be used are counted, and logged ever more rarely.
class SliceReceiver {
 public:
  struct Config {
    std::int64_t session = 0;  ///< of this segmenter, for its resend requests
    std::string map_name;      ///< only slices of this map; empty: all
    /// Of incomplete slices. Beyond it chunks are dropped, which in a log nobody sends again.
    std::size_t max_pending_bytes = std::size_t{1} << 30U;
  };

  /// `queue` must outlive this, and so must `views`, which gets every slice, and the views of a
  /// log; null: nobody keeps views.
  SliceReceiver(const Config& config, SliceQueue& queue, ViewRecorder* views = nullptr);
  /// Stops reading.
  ~SliceReceiver();
  SliceReceiver(const SliceReceiver&) = delete;
  SliceReceiver& operator=(const SliceReceiver&) = delete;

  /// From now on bus.handle() fills the queue; this must outlive that.
  void subscribe(Bus& bus);
  /// Requests what is missing when it is time to; for the thread of bus.handle().
  void ask(Bus& bus, double now_s);

  /// Reads `log` in a thread of its own, as fast as the queue has room, and then closes the queue.
  /// @throws std::runtime_error when it is not an LCM log
  void read(const std::filesystem::path& log);

  /// Accepts nothing more; stops reading a log. Call before problem().
  void stop();

  // From any thread:
  bool reads_log() const { return reads_log_; }
  /// True while missing slices of a session are being resent. Meaningless for a log.
  bool is_coming(std::int64_t map_session) const;
  /// What is in a resumed map need not be received again.
  void restore(const SegmentMap& map) {
    subscriber_.restore(map.map_session(), map.chunks().ranges());
  }
  void forget(std::int64_t map_session) { subscriber_.forget(map_session); }
  StreamCounts counts() const { return subscriber_.counts(); }
  std::size_t pending_bytes() const { return subscriber_.pending_bytes(); }

  /// Why the log could not be read to its end; nothing when it could.
  const std::optional<std::string>& problem() const { return problem_; }

 private:
  StreamRoom room() const;
  void count_bad(const DecodeError& reason);

  SliceQueue& queue_;
  ViewRecorder* views_;
  std::atomic<bool> stopping_{false};
  std::atomic<bool> reads_log_{false};
  std::int64_t num_bad_ = 0;            // of the thread that receives
  std::optional<std::string> problem_;  // of the reader, until it is stopped
  StreamSubscriber<CloudSlice> subscriber_;
  std::thread reader_;
};

}  // namespace kintsugi::segmenter
