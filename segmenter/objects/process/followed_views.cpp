#include "segmenter/objects/process/followed_views.hpp"

#include <stdexcept>

#include <spdlog/spdlog.h>

#include "lcmtypes/base/thread_priority.hpp"
#include "lcmtypes/segment_messages.hpp"
#include "segmenter/io/views_file.hpp"
#include "segmenter/tools/query/query_client.hpp"
#include "segmenter/views/kept_view.hpp"

namespace kintsugi::segmenter {

namespace {

constexpr std::chrono::seconds kPeriod(1);
// A segmenter answers between two slices; where a log is replayed there may be none.
constexpr QueryClient::Seconds kPatience(3.0);
constexpr std::chrono::seconds kSilence(10);  // before one that did not answer is asked again

/// The oldest views of this time and later, as many as one answer holds.
ViewSet next_views(QueryClient& segmenter, std::int64_t map_session, std::int64_t since_us) {
  SegmentQuery query;
  query.place = QueryPlace::kViews;
  query.map_session = map_session;
  query.changed_since = since_us;
  const SegmentAnswer answer = segmenter.ask(std::move(query), kPatience);
  if (!answer.problem.empty()) throw std::runtime_error(answer.problem);
  if (answer.views.empty()) return {};  // it records none
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
    return {.request = request, .problem = error.what()};
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
  end_ = {};
}

void FollowedViews::update(bool map_has_ended, Detector& detector, Clock::time_point now) {
  if (running_.valid()) {
    if (running_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
    use(running_.get(), detector, now);
  }
  const bool is_due = map_has_ended ? !end_.is_asked : now >= due_;
  if (!is_due) return;
  due_ = now + kPeriod;
  if (map_has_ended) next_.since_us = 0;
  end_.is_asked = map_has_ended;
  running_ = std::async(std::launch::async, ask_, next_);
}

void FollowedViews::use(const Answer& answer, Detector& detector, Clock::time_point now) {
  // Of another map, or it lacks what a detector that was made meanwhile has to be told first.
  if (answer.request != next_) return;
  end_.is_told = end_.is_asked;
  if (!answer.problem.empty()) {
    if (!has_warned_) spdlog::warn("what the cameras saw is not used: {}", answer.problem);
    has_warned_ = true;
    due_ = now + kSilence;
    return;
  }
  has_warned_ = false;
  if (answer.request.since_us == 0) {
    detector.set_views(answer.views);
  } else {
    detector.add_views(answer.views);
  }
  if (!answer.views.empty()) next_.since_us = answer.views.back().utime + 1;
}

}  // namespace kintsugi::segmenter
