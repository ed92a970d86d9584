#include "segmenter/session/session_maps.hpp"

#include <algorithm>
#include <bit>
#include <iterator>
#include <utility>

#include <fmt/format.h>

#include "lcmtypes/base/argument_check.hpp"

namespace kintsugi::segmenter {

void SessionMaps::Config::validate() const {
  map.validate();
  each_map.validate();
  require(max_maps >= 1, "max_maps", max_maps, ">= 1");
  require(settle.count() >= 0, "settle [ms]", settle.count(), ">= 0");
}

SessionMaps::SessionMaps(const Config& config, std::int64_t session,
                         std::function<StreamState(std::int64_t)> stream_state, SwapSpace* swap)
    : config_((config.validate(), config)),
      session_(session),
      stream_state_(std::move(stream_state)),
      swap_(swap) {}

void SessionMaps::resume(std::unique_ptr<SegmentMap> map) { begin(std::move(map), {}); }

std::vector<std::string> SessionMaps::offer(CloudSlice slice, Clock::time_point now) {
  Warnings warnings;
  if (Session* const session = find_or_begin(slice, now, warnings)) {
    session->last_news = now;
    const std::int32_t id = slice.id;
    const std::int64_t map_session = slice.session;
    if (const auto why = session->map.offer(std::move(slice), now)) {
      drop(id, map_session, *why, warnings);
    }
  }
  return warnings;
}

SessionMaps::Session* SessionMaps::find_or_begin(const CloudSlice& slice, Clock::time_point now,
                                                 Warnings& warnings) {
  if (!config_.map_name.empty() && slice.map_name != config_.map_name) {
    return nullptr;
  }
  if (const auto found = sessions_.find(slice.session); found != sessions_.end()) {
    return &found->second;
  }
  if (forgotten_.contains(slice.session)) {
    drop(slice.id, slice.session, "its session has ended", warnings);
    return nullptr;
  }
  if (sessions_.size() >= config_.max_maps) {
    drop(slice.id, slice.session, fmt::format("at most {} maps are kept", config_.max_maps),
         warnings);
    return nullptr;
  }
  Session& session = begin(std::make_unique<SegmentMap>(config_.map, session_, slice), now);
  supersede(session.map.segment_map(), now, warnings);
  return &session;
}

SessionMaps::Session& SessionMaps::begin(std::unique_ptr<SegmentMap> map, Clock::time_point now) {
  const std::int64_t map_session = map->map_session();
  if (swap_ != nullptr) map->swap_to(*swap_);
  Session session{SessionMap(config_.each_map, std::move(map)), now};
  return sessions_.try_emplace(map_session, std::move(session)).first->second;
}

// Of each pair of sessions with the name of `map`, the older one is superseded from now on.
void SessionMaps::supersede(const SegmentMap& map, Clock::time_point now, Warnings& warnings) {
  const std::int64_t begun = map.map_session();
  for (auto& [number, other] : sessions_) {
    if (number == begun || other.map.segment_map().map_name() != map.map_name()) {
      continue;
    }
    other.last_news = now;
    warnings.push_back(fmt::format(
        "session {} now owns the map name '{}'; session {} receives only what is still missing of "
        "it, and then ends. Mappers that run at the same time need a --map-name each",
        std::max(number, begun), map.map_name(), std::min(number, begun)));
  }
}

bool SessionMaps::is_superseded(const SegmentMap& map) const {
  return std::any_of(sessions_.upper_bound(map.map_session()), sessions_.end(),
                     [&](const auto& newer) {
                       return newer.second.map.segment_map().map_name() == map.map_name();
                     });
}

StepResult SessionMaps::step(Clock::time_point now) {
  StepResult result = step_next(now);
  end_superseded(now, result);
  return result;
}

// Once closed, one session is finished after the other.
StepResult SessionMaps::step_next(Clock::time_point now) {
  auto next = is_closed_ ? sessions_.begin() : sessions_.upper_bound(last_stepped_session_);
  for (std::size_t i = 0; i < sessions_.size(); ++i, ++next) {
    if (next == sessions_.end()) {
      next = sessions_.begin();
    }
    auto& [number, session] = *next;
    const Outlook outlook = is_closed_ ? Outlook::kEnded : stream_state_(number).outlook;
    StepResult result = session.map.step(now, outlook);
    if (result.has_progressed) {
      session.last_news = now;
      last_stepped_session_ = number;
      for (SaveRequest& request : std::exchange(result.saves, {})) {
        add_request(std::move(request), result.saves);
      }
      return result;
    }
  }
  return {};
}

void SessionMaps::end_superseded(Clock::time_point now, StepResult& result) {
  if (is_closed_ && result.has_progressed) {
    return;  // first every map is finished
  }
  for (auto it = sessions_.begin(); it != sessions_.end(); ++it) {
    auto& [number, session] = *it;
    if (is_superseded(session.map.segment_map()) && can_end(number, session, now)) {
      return end(it, result);
    }
  }
}

bool SessionMaps::can_end(std::int64_t number, Session& session, Clock::time_point now) const {
  if (is_closed_) {
    return true;
  }
  if (!session.map.is_idle() || !stream_state_(number).is_quiet) {
    session.last_news = now;
    return false;
  }
  return now - session.last_news >= config_.settle;
}

void SessionMaps::end(Sessions::iterator session, StepResult& result) {
  const auto number = session->first;
  const SessionMap& map = session->second.map;
  num_missing_ += map.counts().missing;
  result.has_progressed = true;
  result.saves.push_back({map.shared_segment_map(), SaveKind::kSessionEnded});
  result.warnings.push_back(fmt::format("session {} has ended", number));
  result.ended_session = number;
  sessions_.erase(session);
  forgotten_.insert(number);
}

std::vector<SaveRequest> SessionMaps::save(bool again) {
  std::vector<SaveRequest> requests;
  for (auto& [number, session] : sessions_) {
    if (auto request = session.map.save(again)) {
      add_request(*std::move(request), requests);
    }
  }
  return requests;
}

// A map is never written under the name that a newer session owns.
void SessionMaps::add_request(SaveRequest request, std::vector<SaveRequest>& requests) const {
  if (is_superseded(*request.map)) {
    if (request.kind == SaveKind::kForResume) {
      return;
    }
    request.kind = SaveKind::kSessionEnded;
  }
  requests.push_back(std::move(request));
}

// Warns at the 1st, 2nd, 4th, 8th ... slice: a mapper that nobody follows must not fill the log.
void SessionMaps::drop(std::int32_t id, std::int64_t map_session, const std::string& why,
                       Warnings& warnings) {
  if (std::has_single_bit(static_cast<std::uint64_t>(++num_dropped_))) {
    warnings.push_back(
        fmt::format("dropped {} slices so far, the last: slice {} of session {}, because {}",
                    num_dropped_, id, map_session, why));
  }
}

std::vector<SegmentUpdate> SessionMaps::describe() const {
  std::vector<SegmentUpdate> all;
  for (const auto& [number, session] : sessions_) {
    std::ranges::move(session.map.segment_map().describe(), std::back_inserter(all));
  }
  return all;
}

SessionMaps::Counts SessionMaps::counts() const {
  Counts counts;
  counts.maps = std::ssize(sessions_);
  counts.missing = num_missing_;
  counts.dropped = num_dropped_;
  counts.complete = counts.ended = !sessions_.empty();
  for (const auto& [number, session] : sessions_) {
    const SessionMap::Counts& of_map = session.map.counts();
    const bool is_newest = !is_superseded(session.map.segment_map());
    counts.newest = of_map;  // the largest number comes last
    counts.lag += of_map.lag;
    counts.missing += of_map.missing;
    counts.waiting_bytes += session.map.waiting_bytes();
    counts.in_batch = counts.in_batch || session.map.is_in_batch();
    counts.complete = counts.complete && of_map.complete && is_newest;
    counts.ended = counts.ended && of_map.ended && is_newest;
  }
  return counts;
}

std::vector<const SegmentMap*> SessionMaps::maps() const {
  std::vector<const SegmentMap*> maps;
  maps.reserve(sessions_.size());
  for (const auto& [number, session] : sessions_) maps.push_back(&session.map.segment_map());
  return maps;
}

}  // namespace kintsugi::segmenter
