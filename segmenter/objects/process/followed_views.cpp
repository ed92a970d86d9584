#include "segmenter/objects/process/followed_views.hpp"

#include <algorithm>
#include <cstddef>
#include <stdexcept>

#include "lcmtypes/base/logger.hpp"
#include "lcmtypes/base/thread_priority.hpp"
#include "lcmtypes/codec/codec.hpp"
#include "lcmtypes/segment_messages.hpp"
#include "segmenter/io/views_file.hpp"
#include "segmenter/tools/query/query_client.hpp"
#include "segmenter/views/kept_view.hpp"
#include "segmenter/views/view_record.hpp"

namespace kintsugi::segmenter {

namespace {

constexpr std::chrono::seconds kPeriod(1);
// A segmenter answers between two slices; where a log is replayed there may be none.
constexpr QueryClient::Seconds kPatience(3.0);
constexpr std::chrono::seconds kSilence(10);  // before one that did not answer is asked again
// When the map has ended, its last examination waits for the views. Some answers may be lost, but a
// segmenter that ended with its map gives none.
constexpr int kLastTries = 3;
// Between two questions for everything while the map grows: that may be 34 MB of views. Loops close
// in series, and on a patrol in every round.
constexpr std::chrono::seconds kWholePeriod(60);
// With so many views there may be twice as many as the segmenter has: it has thinned out the rest.
constexpr std::size_t kMostViews = 2 * ViewRecord::kMaxViews;

/// The oldest views of this time and later, as many as one answer holds.
ViewSet next_views(QueryClient& segmenter, std::int64_t map_session, std::int64_t since_us) {
  SegmentQuery query;
  query.place = QueryPlace::kViews;
  query.map_session = map_session;
  query.changed_since = since_us;
  const SegmentAnswer answer = segmenter.ask(std::move(query), kPatience);
  if (!answer.problem.empty()) throw std::runtime_error(answer.problem);
  return views_of_bytes(answer.views, "the segmenter's answer");
}

MapView view_in_place(KeptView view) {
  view.patch = KeptView::kNoPatch;  // corrections have moved it already
  return unpacked(view, [](std::int32_t) { return std::nullopt; });
}

FollowedViews::Answer ask_segmenter(const std::string& lcm_url,
                                    const FollowedViews::Request& request) {
  lower_priority_of_thread();
  FollowedViews::Answer answer{.request = request};
  try {
    QueryClient segmenter(lcm_url);
    std::int64_t since_us = request.since_us;
    while (true) {
      ViewSet later = next_views(segmenter, request.map_session, since_us);
      if (later.views.empty()) return answer;
      since_us = later.views.back().utime + 1;
      for (KeptView& view : later.views) answer.views.push_back(view_in_place(std::move(view)));
    }
  } catch (const std::exception& error) {
    answer.problem = error.what();
    return answer;
  }
}

}  // namespace

FollowedViews::Ask FollowedViews::of_segmenter(std::string lcm_url) {
  return [lcm_url = std::move(lcm_url)](const Request& request) {
    return ask_segmenter(lcm_url, request);
  };
}

void FollowedViews::begin(std::int64_t map_session) {
  next_ = {map_session, 0};
  due_ = {};
  is_corrected_ = false;
  whole_due_ = {};
  go_on();
}

/// The segmenter may hear of the correction a little later.
void FollowedViews::note_correction(Clock::time_point now) {
  if (!is_corrected_) due_ = std::max(due_, now + kPeriod);
  is_corrected_ = true;
}

void FollowedViews::go_on() {
  end_ = {};
  problem_.clear();
}

bool FollowedViews::update(bool map_has_ended, Detector& detector, Clock::time_point now) {
  bool is_news = false;
  if (running_.valid()) {
    if (running_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return false;
    is_news = use(running_.get(), detector, now);
  }
  if (!map_has_ended && end_.is_asked) go_on();
  if (map_has_ended && !end_.is_asked) {
    end_.is_asked = true;
    next_.since_us = 0;
    due_ = now;
  }
  if (end_.is_told || now < due_) return is_news;
  const bool is_stale = is_corrected_ || detector.num_views() > kMostViews;
  if (is_stale && !map_has_ended && now >= whole_due_) next_.since_us = 0;
  if (next_.since_us == 0) {
    is_corrected_ = false;
    whole_due_ = now + kWholePeriod;
  }
  due_ = now + kPeriod;
  running_ = std::async(std::launch::async, ask_, next_);
  return is_news;
}

/// What has come before a problem is kept: the next question begins behind it.
/// @return whether the detector was told something else than it knew
bool FollowedViews::use(const Answer& answer, Detector& detector, Clock::time_point now) {
  // Of another map, or it lacks what a detector that was made meanwhile has to be told first.
  if (answer.request != next_) return false;
  bool is_news = false;
  if (answer.request.since_us > 0) {
    detector.add_views(answer.views);
    is_news = !answer.views.empty();
  } else if (answer.problem.empty() || !answer.views.empty()) {
    is_news = detector.set_views(answer.views);
  }
  if (!answer.views.empty()) next_.since_us = answer.views.back().utime + 1;
  if (answer.problem.empty()) {
    has_warned_ = false;
    end_.is_told = end_.is_asked;
  } else if (end_.is_asked) {
    if (++end_.num_failures == kLastTries) give_up(answer.problem);
  } else {
    if (!has_warned_) spdlog::warn("what the cameras saw is not used: {}", answer.problem);
    has_warned_ = true;
    due_ = now + kSilence;
  }
  return is_news;
}

void FollowedViews::give_up(const std::string& reason) {
  end_.is_told = true;
  problem_ =
      "what is found in the saved map may differ: not all that the cameras saw was told: " + reason;
  spdlog::warn("{}", problem_);
}

bool is_moved(std::span<const CloudPoint> before_W, std::span<const CloudPoint> now_W) {
  const auto is_same_point = [](const CloudPoint& a, const CloudPoint& b) {
    return a.red == b.red && a.green == b.green && a.blue == b.blue && a.weight == b.weight;
  };
  const auto is_same_place = [](const CloudPoint& a, const CloudPoint& b) {
    return a.x == b.x && a.y == b.y && a.z == b.z;
  };
  return std::ranges::equal(before_W, now_W, is_same_point) &&
         !std::ranges::equal(before_W, now_W, is_same_place);
}

}  // namespace kintsugi::segmenter
