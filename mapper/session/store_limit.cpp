#include "mapper/session/store_limit.hpp"

#include <exception>
#include <memory>
#include <utility>
#include <vector>

#include "lcmtypes/base/logger.hpp"
#include "lcmtypes/base/process_memory.hpp"
#include "lcmtypes/base/thread_priority.hpp"

namespace kintsugi::mapper {
namespace {

/// After a failure, such as a full disk.
constexpr std::chrono::seconds kRetryPeriod{60};

double mb(std::int64_t bytes) { return 1e-6 * static_cast<double>(bytes); }

}  // namespace

StoreLimit::StoreLimit(BufferedLog& log, std::int64_t max_bytes, bool durable,
                       OnRewritten on_rewritten)
    : log_(log), max_bytes_(max_bytes), durable_(durable), on_rewritten_(std::move(on_rewritten)) {}

StoreLimit::~StoreLimit() { finish(); }

void StoreLimit::poll() {
  if (max_bytes_ == 0 || is_working_ || is_stopped_ || !is_due()) return;
  if (thread_.joinable()) thread_.join();
  is_working_ = true;
  thread_ = std::thread([this] {
    lower_priority_of_thread();
    rewrite();
    return_free_memory();
    is_working_ = false;
  });
}

void StoreLimit::finish() {
  is_stopped_ = true;
  if (thread_.joinable()) thread_.join();
}

std::string StoreLimit::problem() const {
  const std::scoped_lock lock(mutex_);
  return problem_;
}

bool StoreLimit::is_due() const {
  if (Clock::now() < next_try_ || 2 * log_.report().size_bytes <= max_bytes_) return false;
  std::int64_t base_bytes = 0;
  std::int64_t other_bytes = 0;
  for (const LogPart& part : log_.closed()) {
    (part.number == 0 ? base_bytes : other_bytes) += part.file->size_bytes();
  }
  return other_bytes > 0 && 4 * other_bytes >= base_bytes;
}

void StoreLimit::rewrite() {
  const std::vector<LogPart> parts = log_.closed();
  try {
    const std::shared_ptr<LogWriter> base = log_.create_base();
    const RewrittenStreams streams =
        rewrite_log(parts, *base, durable_, [this] { return is_stopped_.load(); });
    log_.replace_first(base, parts.size(), [&] { on_rewritten_(parts.back().number, streams); });
    note_size(base->size_bytes());
  } catch (const std::exception& error) {
    log_.remove_base();  // on a full disk the log needs its space
    next_try_ = Clock::now() + kRetryPeriod;
    if (!is_stopped_) spdlog::warn("the log cannot be rewritten, and grows: {}", error.what());
  }
}

void StoreLimit::note_size(std::int64_t base_bytes) {
  const bool is_too_large =
      static_cast<double>(base_bytes) > kMaxShareOfMap * static_cast<double>(max_bytes_);
  const std::scoped_lock lock(mutex_);
  if (is_too_large == !problem_.empty()) return;
  problem_.clear();
  if (!is_too_large) return;
  problem_ = "the map has " + std::to_string(base_bytes / 1'000'000) +
             " MB in the log, too much for --store-limit; all of it is kept";
  spdlog::warn("{}. With --store-limit {:.0f} the files would stay below it", problem_,
               mb(base_bytes) / kMaxShareOfMap + 1);
}

}  // namespace kintsugi::mapper
