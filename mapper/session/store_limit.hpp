#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

#include "mapper/session/buffered_log.hpp"
#include "mapper/session/log_rewriting.hpp"

namespace kintsugi::mapper {

/// Keeps the files of a log below a limit: when they have half of it, the full ones are rewritten
/// as one that has only what the map still needs (rewrite_log()), by a thread, while the log goes
/// on. For a moment both are there, which is why it is half.
///
/// Everything that is needed is kept, also beyond the limit. Then the log is rewritten each time
/// that it has grown by a quarter of that, and problem() says so.
class StoreLimit {
 public:
  /// Tells the indexes where the chunks are now.
  using OnRewritten = std::function<void(std::int32_t last_file, const RewrittenStreams& streams)>;

  /// Above this share of the limit the map, alone, is too large: with the quarter by which the log
  /// grows before it is rewritten, and the new file beside the old ones, the files reach the limit.
  static constexpr double kMaxShareOfMap = 0.4;
  /// Files of this share of the limit let the log be rewritten in time.
  static constexpr double kShareOfFile = 1.0 / 16;

  /// @param log must outlive this
  /// @param max_bytes of all files; 0: without limit
  StoreLimit(BufferedLog& log, std::int64_t max_bytes, bool durable, OnRewritten on_rewritten);
  ~StoreLimit();
  StoreLimit(const StoreLimit&) = delete;
  StoreLimit& operator=(const StoreLimit&) = delete;

  /// Starts to rewrite the log if it is time to. To be called regularly, by one thread.
  void poll();
  /// Gives up what is in work; nothing is rewritten any more.
  void finish();

  /// That the map is larger than the limit permits; empty: it is not.
  std::string problem() const;

 private:
  using Clock = std::chrono::steady_clock;

  bool is_due() const;
  void rewrite();
  void note_size(std::int64_t base_bytes);

  BufferedLog& log_;
  const std::int64_t max_bytes_;
  const bool durable_;
  const OnRewritten on_rewritten_;
  mutable std::mutex mutex_;  ///< guards problem_
  std::string problem_;
  Clock::time_point next_try_;
  std::atomic<bool> is_working_ = false;
  std::atomic<bool> is_stopped_ = false;
  std::thread thread_;
};

}  // namespace kintsugi::mapper
