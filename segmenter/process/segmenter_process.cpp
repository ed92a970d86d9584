#include "segmenter/process/segmenter_process.hpp"

#include <algorithm>
#include <thread>

#include "lcmtypes/base/argument_check.hpp"
#include "lcmtypes/base/logger.hpp"
#include "lcmtypes/base/stop_signal.hpp"
#include "lcmtypes/channels.hpp"
#include "segmenter/process/process_status.hpp"

namespace kintsugi::segmenter {
namespace {

constexpr std::chrono::milliseconds kPollPeriod{50};
constexpr double kLingerAfterStop_s = 2.0;

/// The limit of a log's incomplete slices is not that of its queue: nobody sends again what is
/// dropped.
SliceReceiver::Config receiver_config(const SegmenterProcess::Config& config,
                                      std::int64_t session) {
  SliceReceiver::Config receiver;
  receiver.session = session;
  receiver.map_name = config.segmentation.maps.map_name;
  if (config.log.empty()) receiver.max_pending_bytes = config.max_queue_bytes;
  return receiver;
}

}  // namespace

void SegmenterProcess::Config::validate() const {
  segmentation.validate();
  updates.validate();
  require(max_queue_bytes > 0, "max_queue_bytes", max_queue_bytes, "> 0");
  require(status_period.count() > 0, "status_period [ms]", status_period.count(), "> 0");
}

SegmenterProcess::SegmenterProcess(const Config& config)
    : config_((config.validate(), config)),
      session_(new_session()),
      bus_(config.log.empty() || config.publish ? std::make_unique<Bus>(config.lcm_url) : nullptr),
      updates_(config.publish ? bus_.get() : nullptr, session_, config.updates),
      queue_(config.max_queue_bytes),
      views_(config.publish || !config.segmentation.files.save_file.empty()
                 ? std::make_unique<ViewRecorder>(config.segmentation.maps.map_name)
                 : nullptr),
      queries_(
          config.publish ? bus_.get() : nullptr, session_, [this] { queue_.wake(); },
          [this](const CameraView& view) { keep(view); }, views_.get()),
      receiver_(receiver_config(config, session_), queue_, views_.get()),
      loop_(config.segmentation, session_,
            {queue_, receiver_, updates_, queries_, clock_, views_.get()}) {}

SegmenterProcess::~SegmenterProcess() = default;

// Beside a log only the views in it count.
void SegmenterProcess::keep(const CameraView& view) {
  if (views_ && config_.log.empty()) views_->add(view);
}

int SegmenterProcess::run() {
  receive();
  std::thread segmenting([this] { segment(); });
  watch();
  segmenting.join();
  receiver_.stop();
  loop_.wait_for_files();
  if (!failure_) {
    updates_.flush();
    linger();
  }
  if (bus_thread_) {
    bus_thread_->stop();
  }
  if (failure_) {
    std::rethrow_exception(failure_);
  }
  publish_status();
  return report();
}

void SegmenterProcess::receive() {
  if (!config_.log.empty()) {
    receiver_.read(config_.log);
  } else {
    receiver_.subscribe(*bus_);
    spdlog::info("listening on {}", bus_->url());
  }
  if (bus_) {
    updates_.subscribe(*bus_);
    queries_.subscribe(*bus_);
    bus_thread_ = std::make_unique<BusThread>(*bus_, [this] {
      if (loop_.has_resumed()) receiver_.ask(*bus_, clock_.now_s());
    });
  }
}

void SegmenterProcess::segment() {
  try {
    loop_.run();
  } catch (...) {
    failure_ = std::current_exception();
  }
  is_segmenting_ = false;
}

void SegmenterProcess::watch() {
  while (is_segmenting_) {
    if (stop_requested() || has_ended()) {
      loop_.end();
    }
    publish_status_when_due();
    std::this_thread::sleep_for(kPollPeriod);
  }
}

bool SegmenterProcess::has_ended() const {
  const bool is_final = config_.exit_on_final && loop_.counts().ended && nothing_is_queued();
  return is_final || (bus_thread_ && bus_thread_->failed());
}

// Everything is published, but some listeners may not have received all of it yet.
void SegmenterProcess::linger() {
  if (!config_.publish) {
    return;
  }
  const bool has_limit = config_.linger_s >= 0.0 || stop_requested();
  const double limit_s = config_.linger_s >= 0.0 ? config_.linger_s : kLingerAfterStop_s;
  rearm_stop_signals();
  is_lingering_ = true;
  next_status_ = {};  // now
  const double begin_s = clock_.now_s();
  while (!stop_requested() && !bus_thread_->failed()) {
    const double quiet_s = std::min(
        {clock_.now_s() - begin_s, updates_.time_since_request_s(), queries_.time_since_query_s()});
    if (has_limit && quiet_s >= limit_s) {
      break;
    }
    loop_.serve();
    publish_status_when_due();
    queries_.wait_for_work(kPollPeriod);
  }
  loop_.wait_for_files();
}

bool SegmenterProcess::nothing_is_queued() const {
  return queue_.size() == 0 && updates_.is_idle();
}

std::string SegmenterProcess::problem() const {
  for (const std::string& problem : {loop_.file_problem(), updates_.problem(), status_problem_}) {
    if (!problem.empty()) {
      return problem;
    }
  }
  return "";
}

void SegmenterProcess::publish_status_when_due() {
  if (const auto now = std::chrono::steady_clock::now(); now >= next_status_) {
    publish_status();
    next_status_ = now + config_.status_period;
  }
}

void SegmenterProcess::publish_status() {
  if (!config_.publish) {
    return;
  }
  SessionMaps::Counts counts = loop_.counts();
  const std::int64_t num_queued = queue_.size();
  counts.newest.received += num_queued;
  counts.lag += num_queued;
  SegmenterStatus status = make_status(counts, receiver_.counts(), updates_.counts());
  status.session = session_;
  status.messages_bad += queries_.messages_bad();
  report_refused(status);
  status.mode = config_.segmentation.maps.map.mode;
  status.finished = counts.complete && nothing_is_queued();
  status.lingering = is_lingering_;
  status.queue_bytes = static_cast<std::int64_t>(queue_.bytes() + receiver_.pending_bytes());
  status.problem = problem();
  try {
    bus_->publish(channels::kSegmenterStatus, status);
  } catch (const std::exception& error) {  // the map is more important than who watches it
    if (status_problem_.empty()) {
      status_problem_ = std::string("the status is not published: ") + error.what();
      spdlog::error("{}", status_problem_);
    }
  }
}

// Logs what was done and everything that went wrong; returns the exit status.
int SegmenterProcess::report() const {
  const SessionMaps::Counts counts = loop_.counts();
  const SessionMap::Counts& map = counts.newest;
  const bool reads_log = !config_.log.empty();
  if (map.segmented > 0) {
    spdlog::info("session {}: {} slices and {} corrections, {:.1f} ms each, {:.1f} ms at most",
                 map.map_session, map.segmented, map.corrected, map.slice_mean_ms,
                 map.slice_max_ms);
  } else if (reads_log) {
    spdlog::error("{}: holds no slice that could be read on {}", config_.log.string(),
                  channels::kCloudSlice);
  }
  if (counts.missing > 0) {
    spdlog::error("{} slices are missing from the map", counts.missing);
  }
  if (receiver_.problem()) {
    spdlog::error("{}", *receiver_.problem());
  } else if (reads_log && map.segmented > 0 && !counts.ended) {
    spdlog::warn("{}: ended, or was stopped, before the final slice", config_.log.string());
  }
  const bool is_good = counts.missing == 0 && !receiver_.problem() && problem().empty() &&
                       (!reads_log || map.segmented > 0);
  return is_good ? 0 : 1;
}

}  // namespace kintsugi::segmenter
