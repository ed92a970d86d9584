#include "segmenter/process/session_maps.hpp"

#include <algorithm>
#include <bit>
#include <iterator>
#include <stdexcept>
#include <utility>

namespace kintsugi::segmenter {

void SessionMaps::Config::validate() const {
  map.validate();
  processor.validate();
  if (max_maps < 1) {
    throw std::invalid_argument("max_maps is 0, must be >= 1");
  }
  if (settle.count() < 0) {
    throw std::invalid_argument("settle is " + std::to_string(settle.count()) +
                                " ms, must be >= 0");
  }
}

SessionMaps::SessionMaps(const Config& config, std::int64_t session, SliceStream stream,
                         SliceProcessor::Outputs outputs)
    : config_((config.validate(), config)),
      session_(session),
      stream_(std::move(stream)),
      outputs_(std::move(outputs)) {}

void SessionMaps::resume(std::unique_ptr<SegmentMap> map) { begin(std::move(map), {}); }

void SessionMaps::offer(CloudSlice slice, Clock::time_point now) {
  Session* const session = find_or_begin(slice, now);
  if (session == nullptr) {
    return;
  }
  session->last_news = now;
  const std::int32_t id = slice.id;
  const std::int64_t map_session = slice.session;
  if (const auto why = session->processor.offer(std::move(slice), now)) {
    drop(id, map_session, *why);
  }
}

SessionMaps::Session* SessionMaps::find_or_begin(const CloudSlice& slice, Clock::time_point now) {
  if (!config_.map_name.empty() && slice.map_name != config_.map_name) {
    return nullptr;
  }
  if (const auto found = sessions_.find(slice.session); found != sessions_.end()) {
    return &found->second;
  }
  if (forgotten_.contains(slice.session)) {
    drop(slice.id, slice.session, "its session has ended");
    return nullptr;
  }
  if (sessions_.size() >= config_.max_maps) {
    drop(slice.id, slice.session, std::to_string(sessions_.size()) + " maps are kept, and no more");
    return nullptr;
  }
  Session& session = begin(std::make_unique<SegmentMap>(config_.map, session_, slice), now);
  supersede(session.processor.map(), now);
  return &session;
}

SessionMaps::Session& SessionMaps::begin(std::unique_ptr<SegmentMap> map, Clock::time_point now) {
  const std::int64_t map_session = map->map_session();
  SliceProcessor processor(
      config_.processor, std::move(map),
      {outputs_.publish, [this](const SegmentMap& map, Save why) { save(map, why); },
       outputs_.warn});
  return sessions_.try_emplace(map_session, Session{std::move(processor), now}).first->second;
}

// From now on one of two sessions waits for its end.
void SessionMaps::supersede(const SegmentMap& map, Clock::time_point now) {
  const std::int64_t begun = map.map_session();
  for (auto& [number, other] : sessions_) {
    if (number == begun || other.processor.map().map_name() != map.map_name()) {
      continue;
    }
    other.last_news = now;
    const std::int64_t older = std::min(number, begun);
    const std::int64_t newer = std::max(number, begun);
    outputs_.warn("session " + std::to_string(newer) + " has the map name '" + map.map_name() +
                  "' now; session " + std::to_string(older) +
                  " gets what is still missing of it, and ends. Two mappers at a time need a "
                  "--map-name each");
  }
}

bool SessionMaps::step(Clock::time_point now) {
  bool has_done_something = false;
  for (auto& [number, session] : sessions_) {
    if (session.processor.step(now, stream_.outlook(number))) {
      session.last_news = now;
      has_done_something = true;
    }
  }
  return end_superseded(now) || has_done_something;
}

bool SessionMaps::is_superseded(const SegmentMap& map) const {
  return std::any_of(
      sessions_.upper_bound(map.map_session()), sessions_.end(),
      [&](const auto& newer) { return newer.second.processor.map().map_name() == map.map_name(); });
}

bool SessionMaps::end_superseded(Clock::time_point now) {
  for (auto it = sessions_.begin(); it != sessions_.end(); ++it) {
    auto& [number, session] = *it;
    if (!is_superseded(session.processor.map())) {
      continue;
    }
    if (!session.processor.is_idle() || !stream_.is_quiet(number)) {
      session.last_news = now;
    } else if (now - session.last_news >= config_.settle) {
      end(it);
      return true;
    }
  }
  return false;
}

void SessionMaps::end(Sessions::iterator session) {
  const auto number = session->first;
  num_missing_ += session->second.processor.counts().missing;
  save(session->second.processor.map(), Save::kSessionEnded);
  outputs_.warn("session " + std::to_string(number) + " has ended");
  sessions_.erase(session);
  forgotten_.insert(number);
  stream_.forget(number);
}

void SessionMaps::finish(Clock::time_point now) {
  for (auto& [number, session] : sessions_) {
    session.processor.finish(now);
  }
  for (auto it = sessions_.begin(); it != sessions_.end();) {
    const auto next = std::next(it);
    if (is_superseded(it->second.processor.map())) {
      end(it);
    }
    it = next;
  }
}

void SessionMaps::save(bool again) {
  for (auto& [number, session] : sessions_) {
    session.processor.save(again);
  }
}

// A map that is superseded does not go under the name that a newer one has.
void SessionMaps::save(const SegmentMap& map, Save why) {
  if (!is_superseded(map)) {
    outputs_.save(map, why);
  } else if (why != Save::kToGoOn) {
    outputs_.save(map, Save::kSessionEnded);
  }
}

// The 1st, 2nd, 4th, 8th ... is told: a mapper that nobody follows does not fill the log.
void SessionMaps::drop(std::int32_t id, std::int64_t map_session, const std::string& why) {
  if (std::has_single_bit(static_cast<std::uint64_t>(++num_dropped_))) {
    outputs_.warn("dropped " + std::to_string(num_dropped_) + " slices so far, the last: slice " +
                  std::to_string(id) + " of session " + std::to_string(map_session) + ", because " +
                  why);
  }
}

std::vector<SegmentUpdate> SessionMaps::describe() const {
  std::vector<SegmentUpdate> all;
  for (const auto& [number, session] : sessions_) {
    std::ranges::move(session.processor.map().describe(), std::back_inserter(all));
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
    const SliceProcessor::Counts& of_map = session.processor.counts();
    const bool is_last = !is_superseded(session.processor.map());
    counts.newest = of_map;  // the largest number comes last
    counts.lag += of_map.lag;
    counts.missing += of_map.missing;
    counts.waiting_bytes += session.processor.waiting_bytes();
    counts.complete = counts.complete && of_map.complete && is_last;
    counts.ended = counts.ended && of_map.ended && is_last;
  }
  return counts;
}

std::vector<const SegmentMap*> SessionMaps::maps() const {
  std::vector<const SegmentMap*> maps;
  maps.reserve(sessions_.size());
  for (const auto& [number, session] : sessions_) maps.push_back(&session.processor.map());
  return maps;
}

const SegmentMap* SessionMaps::map(std::int64_t map_session) const {
  const auto found = sessions_.find(map_session);
  return found == sessions_.end() ? nullptr : &found->second.processor.map();
}

}  // namespace kintsugi::segmenter
