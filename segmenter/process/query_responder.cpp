#include "segmenter/process/query_responder.hpp"

#include <algorithm>
#include <exception>
#include <string>
#include <utility>
#include <vector>

#include <oneapi/tbb/task_arena.h>
#include <sys/resource.h>

#include "lcmtypes/base/logger.hpp"
#include "lcmtypes/bus/message_subscriber.hpp"
#include "lcmtypes/channels.hpp"
#include "segmenter/io/views_file.hpp"
#include "segmenter/query/answer.hpp"
#include "segmenter/query/choose_map.hpp"

namespace kintsugi::segmenter {
namespace {

constexpr std::size_t kMaxWaiting = 64;  // queries; beyond this the oldest is dropped
constexpr std::chrono::seconds kKeepCopy{10};
constexpr int kNiceness = 10;  // half way to the lowest priority

bool is_same(const SegmentQuery& a, const SegmentQuery& b) {
  return a.client == b.client && a.number == b.number;
}

std::vector<MapIdentity> identities(const std::vector<const SegmentMap*>& maps) {
  std::vector<MapIdentity> identities;
  identities.reserve(maps.size());
  for (const SegmentMap* map : maps) identities.push_back({map->map_session(), map->map_name()});
  return identities;
}

/// Allocates memory for so many points and writes to it, because the kernel provides pages only on
/// the first write.
void touch_memory(SegmentMapState& state, std::size_t num_points) {
  state = {};
  state.points_W = std::vector<CloudPoint>(num_points);
  state.segment_ids = std::vector<std::uint32_t>(num_points);
}

SegmentAnswer refusal(const SegmentQuery& query, const std::string& problem) {
  SegmentAnswer answer;
  answer.client = query.client;
  answer.number = query.number;
  answer.problem = fitting_text(problem);
  return answer;
}

}  // namespace

QueryResponder::QueryResponder(Bus* bus, std::int64_t session, std::function<void()> on_work,
                               std::function<void(const CameraView&)> on_view,
                               const ViewRecorder* recorded)
    : bus_(bus),
      session_(session),
      on_work_(std::move(on_work)),
      views_(std::move(on_view)),
      recorded_(recorded),
      thread_([this] { run(); }) {}

QueryResponder::~QueryResponder() {
  {
    const std::lock_guard lock(mutex_);
    is_ending_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void QueryResponder::subscribe(Bus& bus) {
  kintsugi::subscribe<SegmentQuery>(
      bus, channels::kSegmentQuery, [this](const SegmentQuery& query) { take(query); },
      [this](const DecodeError&) { ++num_bad_; });
  views_.subscribe(bus);
}

void QueryResponder::take(const SegmentQuery& query) {
  {
    const std::lock_guard lock(mutex_);
    last_query_ = Clock::now();
    const bool is_waiting = std::ranges::any_of(
        waiting_, [&](const SegmentQuery& other) { return is_same(query, other); });
    if (is_waiting || (current_ && is_same(query, *current_))) return;
    if (waiting_.size() == kMaxWaiting) waiting_.pop_front();
    waiting_.push_back(query);
  }
  has_come_.notify_all();
  on_work_();
}

bool QueryResponder::has_work() const {
  return !waiting_.empty() && !current_ && room_points_ == 0 && bus_ != nullptr;
}

void QueryResponder::wait_for_work(std::chrono::milliseconds timeout) {
  std::unique_lock lock(mutex_);
  has_come_.wait_for(lock, timeout, [this] { return has_work(); });
}

// The query stays in the queue until begin() or drop().
std::optional<SegmentQuery> QueryResponder::next_query() {
  const std::lock_guard lock(mutex_);
  if (has_work()) return waiting_.front();
  const bool is_idle = !current_ && room_points_ == 0;
  if (is_idle && Clock::now() - last_query_ > kKeepCopy) {
    copy_.reset();
    excerpt_ = {};
  }
  return std::nullopt;
}

template <class MakeAnswer>
void QueryResponder::publish(const MakeAnswer& make_answer) {
  try {
    SegmentAnswer answer = make_answer();
    if (!stream_) {
      StreamPublisher::Config config;
      config.max_chunk_bytes = bus_->max_message_bytes();
      stream_ =
          std::make_unique<StreamPublisher>(*bus_, channels::kSegmentAnswer, session_, config);
    }
    answer.utime = wall_clock_us();
    answer.session = session_;
    stream_->publish(std::move(answer));
  } catch (const std::exception& error) {  // segmentation continues; the client asks again
    spdlog::error("an answer is not published: {}", error.what());
  }
}

void QueryResponder::serve(const SessionMaps& maps) {
  const auto query = next_query();
  if (!query) return;
  const std::vector<const SegmentMap*> all = maps.maps();
  try {
    const SegmentMap& map = *all[choose_map(identities(all), *query)];
    if (!needs_excerpt(*query) && !has_room_for(map)) return make_room(map.cloud().num_live());
    prepare(map, *query);
    begin(*query);
  } catch (const std::exception& error) {
    drop(*query);
    publish([&] { return refusal(*query, error.what()); });
  }
}

void QueryResponder::prepare(const SegmentMap& map, const SegmentQuery& query) {
  if (!needs_excerpt(query)) return update_copy(map);
  const Clock::time_point begin = Clock::now();
  take_excerpt(map, query, views_.newest(map.map_session()).get(), excerpt_);
  const std::chrono::duration<double, std::milli> took = Clock::now() - begin;
  spdlog::debug("copied {} of {} points for a query in {:.1f} ms", excerpt_.points_W.size(),
                excerpt_.map_points, took.count());
}

bool QueryResponder::has_room_for(const SegmentMap& map) const {
  return copy_ && copy_->map.state.points_W.capacity() >= map.cloud().num_live();
}

// A quarter more than needed, because the map grows.
void QueryResponder::make_room(std::size_t num_points) {
  if (!copy_) copy_ = std::make_unique<Copy>();
  copy_->version = -1;
  {
    const std::lock_guard lock(mutex_);
    room_points_ = num_points + num_points / 4 + 1;
  }
  changed_.notify_all();
}

void QueryResponder::update_copy(const SegmentMap& map) {
  const Clock::time_point begin = Clock::now();
  const bool is_same_map = copy_->map.state.map_session == map.map_session();
  if (is_same_map && copy_->version == map.version()) return;
  copy_->version = -1;  // in case this throws
  take_snapshot(map, copy_->map);
  copy_->version = map.version();
  const std::chrono::duration<double, std::milli> took = Clock::now() - begin;
  spdlog::debug("copied {} points for a query in {:.1f} ms", copy_->map.state.points_W.size(),
                took.count());
}

void QueryResponder::begin(const SegmentQuery& query) {
  {
    const std::lock_guard lock(mutex_);
    current_ = query;
  }
  drop(query);
  changed_.notify_all();
}

void QueryResponder::drop(const SegmentQuery& query) {
  const std::lock_guard lock(mutex_);
  std::erase_if(waiting_, [&](const SegmentQuery& other) { return is_same(query, other); });
}

SegmentAnswer QueryResponder::current_answer(const SegmentQuery& query) const {
  if (!needs_excerpt(query)) return answer(copy_->map, query);
  SegmentAnswer result = answer(excerpt_, query);
  const bool is_about_views = query.place == QueryPlace::kViews && result.problem.empty();
  if (is_about_views) result.views = recorded_views(query);
  return result;
}

std::vector<std::uint8_t> QueryResponder::recorded_views(const SegmentQuery& query) const {
  const auto all = recorded_ == nullptr ? nullptr : recorded_->views(excerpt_.map_session);
  if (all == nullptr) return view_bytes({excerpt_.map_session, excerpt_.map_name, {}});
  const auto first =
      std::ranges::lower_bound(all->views, query.changed_since, {}, &KeptView::utime);
  const auto count = std::min<std::ptrdiff_t>(kMaxViews, all->views.end() - first);
  return view_bytes({all->map_session, all->map_name, {first, first + count}});
}

// Without the memory, the query that it is for is refused: segmentation continues.
void QueryResponder::take_room(std::size_t num_points) {
  try {
    touch_memory(copy_->map.state, num_points);
  } catch (const std::exception& error) {
    copy_.reset();
    std::optional<SegmentQuery> query;
    {
      const std::lock_guard lock(mutex_);
      if (!waiting_.empty()) query = waiting_.front();
    }
    if (!query) return;
    drop(*query);
    publish([&] {
      return refusal(*query, std::string("no memory for a copy of the map: ") + error.what());
    });
  }
}

void QueryResponder::run() {
  setpriority(PRIO_PROCESS, 0, kNiceness);  // applies to this thread only
  oneapi::tbb::task_arena one_core(1);
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return is_ending_ || current_ || room_points_ > 0; });
    if (is_ending_ && !current_) return;
    const auto query = current_;
    const std::size_t room_points = room_points_;
    lock.unlock();
    if (query) {
      one_core.execute([&] { publish([&] { return current_answer(*query); }); });
    } else {
      take_room(room_points);
    }
    lock.lock();
    current_.reset();
    room_points_ = 0;
    if (!has_work()) continue;
    lock.unlock();
    has_come_.notify_all();
    on_work_();
    lock.lock();
  }
}

double QueryResponder::time_since_query_s() const {
  const std::lock_guard lock(mutex_);
  return std::chrono::duration<double>(Clock::now() - last_query_).count();
}

}  // namespace kintsugi::segmenter
