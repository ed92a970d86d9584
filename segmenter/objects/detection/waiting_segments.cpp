#include "segmenter/objects/detection/waiting_segments.hpp"

#include <algorithm>
#include <cstdlib>

namespace kintsugi::segmenter {

namespace {

// Of the points: a segment that grows from a tenth of an object to all of it is examined ten times.
constexpr double kMuch = 0.25;

}  // namespace

bool WaitingSegments::has_changed_much(std::uint32_t segment, std::int64_t num_points) const {
  const auto known = examined_.find(segment);
  if (known == examined_.end()) return true;
  const std::int64_t difference = std::abs(num_points - known->second);
  return static_cast<double>(difference) > kMuch * static_cast<double>(known->second);
}

void WaitingSegments::add(std::uint32_t segment, std::int64_t num_points, std::int64_t utime,
                          bool is_urgent) {
  const auto [at, is_new] = waiting_.try_emplace(segment, Waiting{.since_us = utime});
  Waiting& waiting = at->second;
  waiting.num_points = num_points;
  now_us_ = std::max(now_us_, utime);
  const bool was_urgent = waiting.is_urgent;
  waiting.is_urgent =
      was_urgent || is_urgent || num_points == 0 || has_changed_much(segment, num_points);
  if (!is_new && waiting.is_urgent == was_urgent) return;
  if (!is_new) std::erase(others_, segment);
  if (num_points == 0) {
    urgent_.push_front(segment);
  } else {
    (waiting.is_urgent ? urgent_ : others_).push_back(segment);
  }
}

bool WaitingSegments::is_turn_of_others() const {
  if (urgent_.empty() || others_.empty()) return urgent_.empty();
  return was_urgent_ && now_us_ - waiting_.at(others_.front()).since_us >= kPatience_us;
}

std::uint32_t WaitingSegments::pop() {
  was_urgent_ = !is_turn_of_others();
  std::deque<std::uint32_t>& from = was_urgent_ ? urgent_ : others_;
  const std::uint32_t segment = from.front();
  from.pop_front();
  const auto at = waiting_.find(segment);
  if (at->second.num_points > 0) {
    examined_[segment] = at->second.num_points;
  } else {
    examined_.erase(segment);
  }
  waiting_.erase(at);
  return segment;
}

void WaitingSegments::erase(std::uint32_t segment) {
  examined_.erase(segment);
  const auto at = waiting_.find(segment);
  if (at == waiting_.end()) return;
  std::erase(at->second.is_urgent ? urgent_ : others_, segment);
  waiting_.erase(at);
}

void WaitingSegments::clear() {
  waiting_.clear();
  urgent_.clear();
  others_.clear();
}

std::vector<std::uint32_t> WaitingSegments::in_order() const {
  std::vector<std::uint32_t> all(urgent_.begin(), urgent_.end());
  all.insert(all.end(), others_.begin(), others_.end());
  return all;
}

std::optional<std::int64_t> WaitingSegments::since_us() const {
  if (empty()) return std::nullopt;
  return waiting_.at((is_turn_of_others() ? others_ : urgent_).front()).since_us;
}

}  // namespace kintsugi::segmenter
