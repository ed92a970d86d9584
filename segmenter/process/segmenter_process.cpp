#include "segmenter/process/segmenter_process.hpp"

#include <optional>
#include <stdexcept>
#include <thread>
#include <utility>

#include <spdlog/spdlog.h>

#include "lcmtypes/channels.hpp"
#include "lcmtypes/stop_signal.hpp"
#include "segmenter/process/process_status.hpp"
#include "segmenter/process/resumed_map.hpp"

namespace kintsugi::segmenter {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kPollPeriod{50};

}  // namespace

void SegmenterProcess::Config::validate() const {
  processor.validate();
  publisher.validate();
  if (status_period.count() <= 0) {
    throw std::invalid_argument("status_period is " + std::to_string(status_period.count()) +
                                " ms, must be > 0");
  }
}

SegmenterProcess::SegmenterProcess(const Config& config)
    : config_((config.validate(), config)),
      session_(new_session()),
      bus_(config.log.empty() || config.publish ? std::make_unique<Bus>(config.lcm_url) : nullptr),
      updates_(config.publish ? bus_.get() : nullptr, session_, config.publisher),
      receiver_(queue_),
      writer_(config.files),
      processor_(config.processor, session_,
                 {[this](SegmentUpdate update) { updates_.publish(std::move(update)); },
                  [this](const SegmentMap& map, SliceProcessor::Save why) { write(map, why); },
                  [](const std::string& text) { spdlog::warn("{}", text); }}) {}

SegmenterProcess::~SegmenterProcess() = default;

int SegmenterProcess::run() {
  receive();
  std::thread worker([this] { work(); });
  watch();
  worker.join();
  receiver_.stop();
  if (bus_thread_) {
    bus_thread_->stop();
  }
  writer_.wait();
  if (failure_) {
    std::rethrow_exception(failure_);
  }
  updates_.flush();
  publish_status();
  return exit_status();
}

void SegmenterProcess::receive() {
  if (!config_.log.empty()) {
    receiver_.read(config_.log);
    return;
  }
  receiver_.subscribe(*bus_);
  bus_thread_ = std::make_unique<BusThread>(*bus_);
  spdlog::info("listening on {}", bus_->url());
}

// What the main thread does while the others work.
void SegmenterProcess::watch() {
  auto next_status = std::chrono::steady_clock::now();
  while (working_) {
    if (stop_requested() || has_ended()) {
      ending_ = true;
    }
    if (const auto now = std::chrono::steady_clock::now(); now >= next_status) {
      publish_status();
      next_status = now + config_.status_period;
    }
    std::this_thread::sleep_for(kPollPeriod);
  }
}

bool SegmenterProcess::has_ended() const {
  const bool is_final = config_.exit_on_final && counts().ended && nothing_is_queued();
  return is_final || (bus_thread_ && bus_thread_->failed());
}

void SegmenterProcess::work() {
  try {
    work_until_end();
  } catch (...) {
    failure_ = std::current_exception();  // read when working_ is false
    processor_.save();
  }
  working_ = false;
}

void SegmenterProcess::work_until_end() {
  if (!config_.resume_file.empty()) {  // what is received meanwhile waits in the queue
    processor_.resume(resume_map(config_.resume_file, config_.processor.map, session_));
    offer_all({});
  }
  bool is_behind = false;
  while (!ending_ && (is_behind || !queue_.is_exhausted())) {
    offer_all(queue_.take(is_behind ? milliseconds(0) : kPollPeriod));
    is_behind = processor_.step(SliceProcessor::Clock::now());
    if (take_write_request()) {
      processor_.save(!writer_.problem().empty());
    }
  }
  offer_all(queue_.take(milliseconds(0)));
  if (stop_requested() && counts().lag > 0) {
    spdlog::info("segmenting what was received, {} slices behind; a second signal leaves it out",
                 counts().lag);
    processor_.save();  // now: what follows may take long
  }
  processor_.finish(SliceProcessor::Clock::now());
  offer_all({});
  writer_.wait();  // what is being written may fail
  processor_.save(!writer_.problem().empty());
}

void SegmenterProcess::offer_all(std::vector<CloudSlice> slices) {
  for (CloudSlice& slice : slices) {
    processor_.offer(std::move(slice), SliceProcessor::Clock::now());
  }
  const std::lock_guard lock(mutex_);
  counts_ = processor_.counts();
}

void SegmenterProcess::write(const SegmentMap& map, SliceProcessor::Save why) {
  switch (why) {
    case SliceProcessor::Save::kCurrent:
      return writer_.write_and_save(map, "segments");
    case SliceProcessor::Save::kBroken:
      return writer_.write(map, "segments");
    case SliceProcessor::Save::kSessionEnded:
      return writer_.write(map, "segments_" + std::to_string(map.map_session()));
  }
}

SliceProcessor::Counts SegmenterProcess::counts() const {
  const std::lock_guard lock(mutex_);
  return counts_;
}

bool SegmenterProcess::nothing_is_queued() const {
  return queue_.size() == 0 && updates_.is_idle();
}

void SegmenterProcess::publish_status() {
  if (!config_.publish) {
    return;
  }
  SliceProcessor::Counts counts = this->counts();
  const std::int64_t num_queued = queue_.size();
  counts.received += num_queued;
  counts.lag += num_queued;
  SegmenterStatus status = make_status(counts, receiver_.counts());
  status.session = session_;
  status.mode = config_.processor.map.mode;
  status.finished = counts.complete && nothing_is_queued();
  try {
    bus_->publish(channels::kSegmenterStatus, status);
  } catch (const std::exception& error) {  // nobody watches: the map is made all the same
    if (status_problem_.empty()) {
      status_problem_ = std::string("the status is not published: ") + error.what();
      spdlog::error("{}", status_problem_);
    }
  }
}

// Tells what was done, and everything that is wrong with it.
int SegmenterProcess::exit_status() const {
  const SliceProcessor::Counts counts = this->counts();
  if (counts.segmented > 0) {
    spdlog::info("session {}: {} slices and {} corrections, {:.1f} ms each, {:.1f} ms at most",
                 counts.map_session, counts.segmented, counts.corrected, counts.slice_mean_ms,
                 counts.slice_max_ms);
  } else if (!config_.log.empty()) {
    spdlog::error("{}: holds no slice that could be read on {}", config_.log.string(),
                  channels::kCloudSlice);
  }
  if (counts.missing > 0) {
    spdlog::error("{} slices are missing from the map", counts.missing);
  }
  if (receiver_.problem()) {
    spdlog::error("{}", *receiver_.problem());
  } else if (!config_.log.empty() && counts.segmented > 0 && !counts.ended) {
    spdlog::warn("{}: read to its end, or stopped, before the final slice", config_.log.string());
  }
  const bool is_good = counts.missing == 0 && !receiver_.problem() && writer_.problem().empty() &&
                       updates_.problem().empty() && status_problem_.empty() &&
                       (config_.log.empty() || counts.segmented > 0);
  return is_good ? 0 : 1;
}

}  // namespace kintsugi::segmenter
