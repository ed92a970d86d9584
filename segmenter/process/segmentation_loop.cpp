#include "segmenter/process/segmentation_loop.hpp"

#include <utility>

#include "lcmtypes/base/argument_check.hpp"
#include "lcmtypes/base/logger.hpp"
#include "lcmtypes/base/service_notice.hpp"
#include "lcmtypes/base/stop_signal.hpp"
#include "segmenter/output/map_stem.hpp"
#include "segmenter/process/resumed_map.hpp"

namespace kintsugi::segmenter {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kPollPeriod{50};
constexpr char kDefaultMapName[] = "map";  // of a mapper without --map-name

SwapSpace* make_swap(const SegmentationLoop::Config& config, std::optional<SwapSpace>& space) {
  if (!config.swap) return nullptr;
  std::filesystem::create_directories(config.files.folder);  // the swap file may be there, too
  return &space.emplace(*config.swap);
}

void log_all(const std::vector<std::string>& warnings) {
  for (const std::string& warning : warnings) {
    spdlog::warn("{}", warning);
  }
}

}  // namespace

void SegmentationLoop::Config::validate() const {
  maps.validate();
  if (swap) swap->validate();
  require(rewrite_period.count() > 0, "rewrite_period [ms]", rewrite_period.count(), "> 0");
}

SegmentationLoop::SegmentationLoop(const Config& config, std::int64_t session,
                                   const Connections& connections)
    : config_((config.validate(), config)),
      session_(session),
      with_(connections),
      writer_(config.files),
      maps_(
          config.maps, session,
          [this](std::int64_t map_session) { return stream_state(map_session); },
          make_swap(config, swap_)) {}

void SegmentationLoop::run() {
  try {
    resume();
    has_resumed_ = true;
    segment_until_end();
    segment_rest();
  } catch (...) {
    write_all(maps_.save());
    throw;
  }
}

// Slices that are received while the map is loaded wait in the queue.
void SegmentationLoop::resume() {
  if (!config_.resume_file.empty()) {
    auto map = resume_map(config_.resume_file, config_.maps.map, config_.maps.map_name, session_);
    if (with_.views != nullptr) resume_views(config_.resume_file, *map, *with_.views);
    with_.receiver.restore(*map);
    maps_.resume(std::move(map));
    with_.updates.publish_state(maps_.describe(), with_.clock.now_s());
    update_counts();
  }
}

void SegmentationLoop::segment_until_end() {
  bool is_behind = false;
  while (!is_ending_ && (is_behind || !with_.queue.is_exhausted())) {
    add(with_.queue.take(is_behind ? milliseconds(0) : kPollPeriod));
    is_behind = step();
    with_.queue.set_waiting(counts_.waiting_bytes, !is_behind, !is_behind && counts_.in_batch);
    serve();
  }
}

void SegmentationLoop::segment_rest() {
  add(with_.queue.take(milliseconds(0)));
  if (stop_requested() && counts_.lag > 0) {
    spdlog::info("segmenting what was received, {} slices behind; a second stop signal skips this",
                 counts_.lag);
    write_all(maps_.save());  // now, because the rest may take long
  }
  maps_.close();
  while (step()) {
  }
  with_.queue.set_waiting(counts_.waiting_bytes, false);
  write_all(maps_.save());
  writer_.wait();
  writer_.try_again();
}

void SegmentationLoop::add(std::vector<CloudSlice> slices) {
  for (CloudSlice& slice : slices) {
    log_all(maps_.offer(std::move(slice), now()));
  }
  update_counts();
}

bool SegmentationLoop::step() {
  tell_service_manager();
  StepResult result = maps_.step(now());
  for (SegmentUpdate& update : result.updates) {
    with_.updates.publish(std::move(update));
  }
  write_all(result.saves);
  log_all(result.warnings);
  if (result.ended_session) {
    with_.receiver.forget(*result.ended_session);
  }
  if (swap_) trim_memory();
  update_counts();
  return result.has_progressed;
}

void SegmentationLoop::trim_memory() {
  const bool is_first = swap_->file_bytes() == 0;
  swap_->trim();
  if (is_first && swap_->file_bytes() > 0) {
    spdlog::info(
        "the limit of {} MB of memory is reached: parts of the map that are not used for long go "
        "to a file in {}",
        config_.swap->max_anonymous_bytes / 1'000'000, config_.swap->folder.string());
  }
  const std::lock_guard lock(mutex_);
  if (swap_problem_.empty() && !swap_->problem().empty()) spdlog::error("{}", swap_->problem());
  swap_problem_ = swap_->problem();
}

void SegmentationLoop::serve() {
  tell_service_manager();
  if (with_.updates.take_state_request(with_.clock.now_s())) {
    with_.updates.publish_state(maps_.describe(), with_.clock.now_s());
  }
  with_.queries.serve(maps_);
  if (take_write_request()) {
    write_all(maps_.save(!writer_.problem().empty()));
  }
  if (writer_.problem().empty()) {
    next_rewrite_ = now() + config_.rewrite_period;
  } else if (now() >= next_rewrite_) {
    writer_.try_again();
    next_rewrite_ = now() + config_.rewrite_period;
  }
}

void SegmentationLoop::write_all(const std::vector<SaveRequest>& requests) {
  for (const SaveRequest& request : requests) {
    write(request);
  }
}

// Only the main map can be resumed from a file; the others are rebuilt from the slices that their
// mappers resend.
void SegmentationLoop::write(const SaveRequest& request) {
  const SegmentMap& map = *request.map;
  const std::string& name = config_.maps.map_name;
  const std::string stem = map_stem(map.map_name(), name.empty() ? kDefaultMapName : name);
  const bool is_main = stem == map_stem("", "");
  switch (request.kind) {
    case SaveKind::kCurrent:
      return is_main ? writer_.write_and_save(map, stem, views_of(map)) : writer_.write(map, stem);
    case SaveKind::kForResume:
      return is_main ? writer_.save(map, views_of(map)) : void();
    case SaveKind::kBroken:
      return writer_.write(map, stem);
    case SaveKind::kSessionEnded:
      return writer_.write(map, session_stem(stem, map.map_session()));
  }
}

MapWriter::Views SegmentationLoop::views_of(const SegmentMap& map) const {
  return with_.views == nullptr ? nullptr : with_.views->views(map.map_session());
}

void SegmentationLoop::update_counts() {
  const std::lock_guard lock(mutex_);
  counts_ = maps_.counts();
}

SessionMaps::Counts SegmentationLoop::counts() const {
  const std::lock_guard lock(mutex_);
  return counts_;
}

std::string SegmentationLoop::file_problem() const {
  std::string problem = writer_.problem();
  if (!problem.empty()) return problem;
  const std::lock_guard lock(mutex_);
  return swap_problem_;
}

// Nobody resends what is missing in a log; but what was resent while it was recorded may lie
// anywhere in it, so no session of a log is quiet before its end.
StreamState SegmentationLoop::stream_state(std::int64_t map_session) const {
  if (with_.receiver.reads_log()) {
    return {.outlook = Outlook::kSilent, .is_quiet = false};
  }
  const bool is_coming = with_.receiver.is_coming(map_session);
  return {.outlook = is_coming ? Outlook::kLive : Outlook::kSilent, .is_quiet = !is_coming};
}

SegmentationLoop::Clock::time_point SegmentationLoop::now() const {
  return Clock::time_point(std::chrono::duration_cast<Clock::duration>(
      std::chrono::duration<double>(with_.clock.now_s())));
}

}  // namespace kintsugi::segmenter
