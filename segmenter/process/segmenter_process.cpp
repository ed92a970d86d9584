#include "segmenter/process/segmenter_process.hpp"

#include <algorithm>
#include <stdexcept>
#include <thread>
#include <utility>

#include <spdlog/spdlog.h>

#include "lcmtypes/base/stop_signal.hpp"
#include "lcmtypes/channels.hpp"
#include "segmenter/process/map_stem.hpp"
#include "segmenter/process/process_status.hpp"
#include "segmenter/process/resumed_map.hpp"

namespace kintsugi::segmenter {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kPollPeriod{50};
constexpr double kLingerAfterStop_s = 2.0;
constexpr char kDefaultMapName[] = "map";  // of a mapper that is not given another

void require_positive(const char* field, std::int64_t value) {
  if (value <= 0) {
    throw std::invalid_argument(std::string(field) + " is " + std::to_string(value) +
                                ", must be > 0");
  }
}

}  // namespace

void SegmenterProcess::Config::validate() const {
  maps.validate();
  updates.validate();
  require_positive("max_queue_bytes", static_cast<std::int64_t>(max_queue_bytes));
  require_positive("status_period [ms]", status_period.count());
  require_positive("rewrite_period [ms]", rewrite_period.count());
}

SegmenterProcess::SegmenterProcess(const Config& config)
    : config_((config.validate(), config)),
      session_(new_session()),
      bus_(config.log.empty() || config.publish ? std::make_unique<Bus>(config.lcm_url) : nullptr),
      updates_(config.publish ? bus_.get() : nullptr, session_, config.updates),
      queries_(config.publish ? bus_.get() : nullptr, session_),
      queue_(config.max_queue_bytes),
      receiver_({session_, config.maps.map_name, config.max_queue_bytes}, queue_),
      writer_(config.files),
      maps_(config.maps, session_, slice_stream(),
            {[this](SegmentUpdate update) { updates_.publish(std::move(update)); },
             [this](const SegmentMap& map, SessionMaps::Save why) { write(map, why); },
             [](const std::string& text) { spdlog::warn("{}", text); }}) {}

SegmenterProcess::~SegmenterProcess() = default;

// Nobody sends what is missing in a log; but what comes late in it may lie anywhere.
SliceStream SegmenterProcess::slice_stream() {
  const bool is_live = config_.log.empty();
  const auto is_coming = [this](std::int64_t session) { return receiver_.is_coming(session); };
  return {[=](std::int64_t session) {
            return is_live && is_coming(session) ? Outlook::kLive : Outlook::kSilent;
          },
          [=](std::int64_t session) { return is_live && !is_coming(session); },
          [this](std::int64_t session) { receiver_.forget(session); }};
}

int SegmenterProcess::run() {
  receive();
  std::thread worker([this] { work(); });
  watch();
  worker.join();
  receiver_.stop();
  writer_.wait();
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
  return exit_status();
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
    bus_thread_ =
        std::make_unique<BusThread>(*bus_, [this] { receiver_.ask(*bus_, clock_.now_s()); });
  }
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

// Everything is published; some may not have it yet.
void SegmenterProcess::linger() {
  if (!config_.publish) {
    return;
  }
  const bool has_limit = config_.linger_s >= 0.0 || stop_requested();
  const double limit_s = config_.linger_s >= 0.0 ? config_.linger_s : kLingerAfterStop_s;
  rearm_stop_signals();
  lingering_ = true;
  const double begin_s = clock_.now_s();
  Clock::time_point next_status{};
  while (!stop_requested() && !bus_thread_->failed()) {
    const double quiet_s = std::min(
        {clock_.now_s() - begin_s, updates_.time_since_request_s(), queries_.time_since_query_s()});
    if (has_limit && quiet_s >= limit_s) {
      break;
    }
    answer();
    save_what_is_due();
    if (now() >= next_status) {
      publish_status();
      next_status = now() + config_.status_period;
    }
    std::this_thread::sleep_for(kPollPeriod);
  }
  writer_.wait();
}

void SegmenterProcess::work() {
  try {
    work_until_end();
  } catch (...) {
    failure_ = std::current_exception();  // read when working_ is false
    maps_.save();
  }
  working_ = false;
}

void SegmenterProcess::work_until_end() {
  resume();
  bool is_behind = false;
  while (!ending_ && (is_behind || !queue_.is_exhausted())) {
    offer_all(queue_.take(is_behind ? milliseconds(0) : kPollPeriod));
    is_behind = maps_.step(now());
    offer_all({});
    queue_.set_waiting(counts_.waiting_bytes, !is_behind);
    answer();
    save_what_is_due();
  }
  offer_all(queue_.take(milliseconds(0)));
  if (stop_requested() && counts_.lag > 0) {
    spdlog::info("segmenting what was received, {} slices behind; a second signal leaves it out",
                 counts_.lag);
    maps_.save();  // now: what follows may take long
  }
  maps_.finish(now());
  offer_all({});
  queue_.set_waiting(counts_.waiting_bytes, false);
  maps_.save();
  writer_.wait();
  writer_.try_again();
}

// What is received meanwhile waits in the queue.
void SegmenterProcess::resume() {
  if (!config_.resume_file.empty()) {
    auto map = resume_map(config_.resume_file, config_.maps.map, session_);
    receiver_.restore(*map);
    maps_.resume(std::move(map));
    updates_.publish_state(maps_.describe(), clock_.now_s());
    offer_all({});
  }
}

void SegmenterProcess::offer_all(std::vector<CloudSlice> slices) {
  for (CloudSlice& slice : slices) {
    maps_.offer(std::move(slice), now());
  }
  const std::lock_guard lock(mutex_);
  counts_ = maps_.counts();
}

// Who came late gets everything, and who asks what was asked for.
void SegmenterProcess::answer() {
  if (updates_.take_state_request(clock_.now_s())) {
    updates_.publish_state(maps_.describe(), clock_.now_s());
  }
  queries_.serve(maps_);
}

void SegmenterProcess::save_what_is_due() {
  if (take_write_request()) {
    maps_.save(!writer_.problem().empty());
  }
  if (writer_.problem().empty()) {
    next_rewrite_ = now() + config_.rewrite_period;
  } else if (now() >= next_rewrite_) {
    writer_.try_again();
    next_rewrite_ = now() + config_.rewrite_period;
  }
}

// One map is saved to go on with; the others are made again from what their mappers have sent.
void SegmenterProcess::write(const SegmentMap& map, SessionMaps::Save why) {
  const std::string& name = config_.maps.map_name;
  const std::string stem = map_stem(map.map_name(), name.empty() ? kDefaultMapName : name);
  const bool is_main = stem == map_stem("", "");
  switch (why) {
    case SessionMaps::Save::kCurrent:
      return is_main ? writer_.write_and_save(map, stem) : writer_.write(map, stem);
    case SessionMaps::Save::kToGoOn:
      return is_main ? writer_.save(map) : void();
    case SessionMaps::Save::kBroken:
      return writer_.write(map, stem);
    case SessionMaps::Save::kSessionEnded:
      return writer_.write(map, session_stem(stem, map.map_session()));
  }
}

SessionMaps::Clock::time_point SegmenterProcess::now() {
  return Clock::time_point(
      std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(clock_.now_s())));
}

SessionMaps::Counts SegmenterProcess::counts() const {
  const std::lock_guard lock(mutex_);
  return counts_;
}

bool SegmenterProcess::nothing_is_queued() const {
  return queue_.size() == 0 && updates_.is_idle();
}

std::string SegmenterProcess::problem() const {
  for (const std::string& problem : {writer_.problem(), updates_.problem(), status_problem_}) {
    if (!problem.empty()) {
      return problem;
    }
  }
  return "";
}

void SegmenterProcess::publish_status() {
  if (!config_.publish) {
    return;
  }
  SessionMaps::Counts counts = this->counts();
  const std::int64_t num_queued = queue_.size();
  counts.newest.received += num_queued;
  counts.lag += num_queued;
  SegmenterStatus status = make_status(counts, receiver_.counts(), updates_.counts());
  status.session = session_;
  status.messages_bad += queries_.messages_bad();
  status.mode = config_.maps.map.mode;
  status.finished = counts.complete && nothing_is_queued();
  status.lingering = lingering_;
  status.queue_bytes = static_cast<std::int64_t>(queue_.bytes() + receiver_.pending_bytes());
  status.problem = problem();
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
  const SessionMaps::Counts counts = this->counts();
  const SliceProcessor::Counts& map = counts.newest;
  if (map.segmented > 0) {
    spdlog::info("session {}: {} slices and {} corrections, {:.1f} ms each, {:.1f} ms at most",
                 map.map_session, map.segmented, map.corrected, map.slice_mean_ms,
                 map.slice_max_ms);
  } else if (!config_.log.empty()) {
    spdlog::error("{}: holds no slice that could be read on {}", config_.log.string(),
                  channels::kCloudSlice);
  }
  if (counts.missing > 0) {
    spdlog::error("{} slices are missing from the map", counts.missing);
  }
  if (receiver_.problem()) {
    spdlog::error("{}", *receiver_.problem());
  } else if (!config_.log.empty() && map.segmented > 0 && !counts.ended) {
    spdlog::warn("{}: read to its end, or stopped, before the final slice", config_.log.string());
  }
  const bool is_good = counts.missing == 0 && !receiver_.problem() && problem().empty() &&
                       (config_.log.empty() || map.segmented > 0);
  return is_good ? 0 : 1;
}

}  // namespace kintsugi::segmenter
