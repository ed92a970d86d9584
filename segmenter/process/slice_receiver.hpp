#pragma once
// From the bus, or a log, to whole slices.

#include <atomic>
#include <filesystem>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "lcmtypes/bus.hpp"
#include "lcmtypes/stream_subscriber.hpp"
#include "segmenter/process/slice_queue.hpp"

namespace kintsugi::segmenter {

/// Decodes and joins chunks and puts slices into a queue, in a thread that waits for nobody else.
/// Messages that cannot be used are counted, and told of ever more rarely.
class SliceReceiver {
 public:
  /// `queue` must outlive this.
  explicit SliceReceiver(SliceQueue& queue);
  /// Stops reading.
  ~SliceReceiver();
  SliceReceiver(const SliceReceiver&) = delete;
  SliceReceiver& operator=(const SliceReceiver&) = delete;

  /// From now on bus.handle() fills the queue; this must outlive that.
  void subscribe(Bus& bus);

  /// Reads `log` in a thread of its own, as fast as it can, and then closes the queue. Throws
  /// std::runtime_error when it is no log.
  void read(const std::filesystem::path& log);

  /// Reads no further; call before problem().
  void stop();

  /// Why the log could not be read to its end; nothing when it could.
  [[nodiscard]] const std::optional<std::string>& problem() const { return problem_; }

  [[nodiscard]] StreamCounts counts() const { return subscriber_.counts(); }

 private:
  void bad(const DecodeError& reason);

  SliceQueue& queue_;
  StreamSubscriber<CloudSlice> subscriber_;
  std::int64_t num_bad_ = 0;  // of the thread that receives
  std::atomic<bool> stopping_{false};
  std::optional<std::string> problem_;  // of the reader, until it is stopped
  std::thread reader_;
};

}  // namespace kintsugi::segmenter
