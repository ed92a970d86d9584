#include "segmenter/segmenter_process.hpp"

#include <optional>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "lcmtypes/bus_thread.hpp"
#include "lcmtypes/channels.hpp"
#include "lcmtypes/log_reader.hpp"
#include "lcmtypes/stop_signal.hpp"
#include "segmenter/io/map_files.hpp"
#include "segmenter/io/saved_map.hpp"
#include "segmenter/process_status.hpp"

namespace kintsugi::segmenter {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kPollPeriod{50};

void write_files(const MapSnapshot& map, const std::filesystem::path& folder,
                 const std::string& stem) {
  write_map_files(map, folder, stem);
  spdlog::info("wrote {}.ply and .json: {} slices, {} points, {} segments",
               (folder / stem).string(), map.state.slices.size(), map.state.points_W.size(),
               map.segments.size());
}

void keep(const MapSnapshot& map, const std::filesystem::path& file) {
  if (file.has_parent_path()) {
    std::filesystem::create_directories(file.parent_path());
  }
  write_map_state(map.state, file);
  spdlog::info("saved {}: {} slices to go on with", file.string(), map.state.slices.size());
}

// A map goes on with the parameters it began with; those that do not matter to it may differ.
void require_same(const std::filesystem::path& file, const SegmentMapConfig& saved,
                  const SegmentMapConfig& wanted) {
  const auto require = [&](const char* option, const auto& was, const auto& is) {
    if (was != is) {
      throw std::runtime_error(
          fmt::format("'{}' was saved with {} {}, and here it is {}: give {} {} "
                      "to go on with it",
                      file.string(), option, was, is, option, was));
    }
  };
  require("--mode", saved.mode, wanted.mode);
  require("--threshold", saved.engine.threshold, wanted.engine.threshold);
  require("--scale", saved.engine.scale, wanted.engine.scale);
  require("--beta", saved.engine.beta, wanted.engine.beta);
  require("--radius-factor", saved.engine.radius_factor, wanted.engine.radius_factor);
}

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
      subscriber_(
          channels::kCloudSlice, [this](CloudSlice slice) { queue_.push(std::move(slice)); },
          [](const DecodeError& error) { spdlog::warn("dropped a message: {}", error.what()); }),
      processor_(config.processor, session_,
                 {[this](SegmentUpdate update) { publish(std::move(update)); },
                  [this](const SegmentMap& map, SliceProcessor::Save why) { save(map, why); },
                  [](const std::string& text) { spdlog::warn("{}", text); }}) {
  if (config_.log.empty() || config_.publish) {
    bus_ = std::make_unique<Bus>(config_.lcm_url);
  }
  if (config_.publish) {
    publisher_ = std::make_unique<StreamPublisher>(*bus_, channels::kSegmentUpdate, session_,
                                                   config_.publisher);
  }
}

SegmenterProcess::~SegmenterProcess() = default;

int SegmenterProcess::run() {
  std::thread worker([this] { work(); });
  try {
    config_.log.empty() ? receive_from_bus() : receive_from_log();
  } catch (...) {
    ending_ = true;
    worker.join();
    throw;
  }
  worker.join();
  writer_.wait();
  if (failure_) {
    std::rethrow_exception(failure_);
  }
  tell_what_was_done();
  if (counts().missing > 0) {
    fail(std::to_string(counts().missing) + " slices are missing from the map");
  }
  if (publisher_) {
    publisher_->flush();
    publish_status();
  }
  return has_failed_ ? 1 : 0;
}

void SegmenterProcess::receive_from_bus() {
  subscriber_.subscribe(*bus_);
  BusThread receiver(*bus_);
  spdlog::info("listening on {}", bus_->url());
  while (working_ && !receiver.failed()) {
    wait_for_end();
  }
  ending_ = true;
  receiver.stop();
}

void SegmenterProcess::receive_from_log() {
  LogReader log(config_.log);
  std::jthread reader([this, &log] {
    try {
      while (const auto event = log.next()) {
        if (ending_) return;
        subscriber_.handle(event->channel, event->data);
      }
    } catch (const std::exception& error) {
      fail(error.what());
    }
    queue_.close();
  });
  while (working_) {
    wait_for_end();
  }
  ending_ = true;
  reader.join();

  const std::string name = config_.log.string();
  if (log.damage()) {
    fail(*log.damage());
  }
  if (failure_) {
    return;  // which says more than what it left undone; run() throws it
  }
  if (counts().segmented == 0) {
    fail(name + ": holds no slice that could be read on " + channels::kCloudSlice);
  } else if (!counts().ended) {
    spdlog::warn("{}: read to its end, or stopped, before the final slice", name);
  }
}

// One round of what the main thread does meanwhile.
void SegmenterProcess::wait_for_end() {
  const auto until = std::chrono::steady_clock::now() + config_.status_period;
  while (working_ && std::chrono::steady_clock::now() < until) {
    std::this_thread::sleep_for(kPollPeriod);
    if (stop_requested() || (config_.exit_on_final && counts().ended && nothing_is_queued())) {
      ending_ = true;
    }
  }
  publish_status();
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
  if (!config_.resume_file.empty()) {
    resume();
  }
  bool is_behind = false;
  while (!ending_ && (is_behind || !queue_.is_exhausted())) {
    offer_all(queue_.take(is_behind ? milliseconds(0) : kPollPeriod));
    is_behind = processor_.step(SliceProcessor::Clock::now());
    if (take_write_request()) {
      processor_.save(is_write_due_);
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
  processor_.save(is_write_due_);
}

// What is received meanwhile waits in the queue.
void SegmenterProcess::resume() {
  SegmentMapState state = read_map_state(config_.resume_file);
  require_same(config_.resume_file, state.config, config_.processor.map);
  state.config.engine.neighbour_search = config_.processor.map.engine.neighbour_search;
  state.config.engine.audit = config_.processor.map.engine.audit;
  state.session = session_;  // listeners tell the streams of two segmenters apart by it
  processor_.resume(make_map(state, config_.resume_file));
  spdlog::info("resumed {}: {} slices, {} points of session {}", config_.resume_file.string(),
               state.slices.size(), state.points_W.size(), state.map_session);
  offer_all({});
}

void SegmenterProcess::offer_all(std::vector<CloudSlice> slices) {
  for (CloudSlice& slice : slices) {
    processor_.offer(std::move(slice), SliceProcessor::Clock::now());
  }
  const std::lock_guard lock(mutex_);
  counts_ = processor_.counts();
}

void SegmenterProcess::publish(SegmentUpdate update) {
  if (!publisher_) {
    return;
  }
  try {
    publisher_->publish(std::move(update));
  } catch (const std::exception& error) {  // the map is worth keeping without a listener
    fail(std::string("an update is not published: ") + error.what());
  }
}

// Copies what is written, and leaves the writing to the writer.
void SegmenterProcess::save(const SegmentMap& map, SliceProcessor::Save why) {
  const bool is_current = why != SliceProcessor::Save::kSessionEnded;
  const std::string stem =
      is_current ? "segments" : "segments_" + std::to_string(map.map_session());
  const bool is_kept = why == SliceProcessor::Save::kCurrent && !config_.save_file.empty();
  try_to_write([&] {
    const auto snapshot = std::make_shared<const MapSnapshot>(take_snapshot(map));
    writer_.put(stem, [this, stem, snapshot, is_kept] {
      is_write_due_ = false;
      try_to_write([&] { write_files(*snapshot, config_.output_folder, stem); });
      if (is_kept) {
        try_to_write([&] { keep(*snapshot, config_.save_file); });
      }
    });
  });
}

template <class Action>
void SegmenterProcess::try_to_write(Action&& action) {
  try {
    action();
  } catch (const std::exception& error) {  // the map goes on, and is written again at the end
    is_write_due_ = true;
    fail(std::string("the map is not written: ") + error.what());
  }
}

SliceProcessor::Counts SegmenterProcess::counts() const {
  const std::lock_guard lock(mutex_);
  return counts_;
}

void SegmenterProcess::tell_what_was_done() const {
  const SliceProcessor::Counts counts = this->counts();
  if (counts.segmented > 0) {
    spdlog::info("session {}: {} slices and {} corrections, {:.1f} ms each, {:.1f} ms at most",
                 counts.map_session, counts.segmented, counts.corrected, counts.slice_mean_ms,
                 counts.slice_max_ms);
  }
}

void SegmenterProcess::fail(const std::string& what) {
  spdlog::error("{}", what);
  has_failed_ = true;
}

bool SegmenterProcess::nothing_is_queued() const {
  return queue_.size() == 0 && (!publisher_ || publisher_->queued_bytes() == 0);
}

void SegmenterProcess::publish_status() {
  if (!publisher_) {
    return;
  }
  SliceProcessor::Counts counts = this->counts();
  const std::int64_t num_queued = queue_.size();
  counts.received += num_queued;
  counts.lag += num_queued;
  SegmenterStatus status = make_status(counts, subscriber_.counts());
  status.session = session_;
  status.mode = config_.processor.map.mode;
  status.finished = counts.complete && nothing_is_queued();
  try {
    bus_->publish(channels::kSegmenterStatus, status);
  } catch (const std::exception& error) {  // nobody watches: the map is made all the same
    if (!std::exchange(status_has_failed_, true)) {
      fail(std::string("the status is not published: ") + error.what());
    }
  }
}

}  // namespace kintsugi::segmenter
