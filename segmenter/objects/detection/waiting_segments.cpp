#include "segmenter/objects/detection/waiting_segments.hpp"

#include <algorithm>
#include <cstdlib>

namespace kintsugi::segmenter {

namespace {

// Of the points: a segment that grows from a tenth of an object to all of it is examined ten times.
constexpr double kMuch = 0.25;

bool differ_much(std::int64_t before, std::int64_t now) {
  return static_cast<double>(std::abs(now - before)) > kMuch * static_cast<double>(before);
}

// Before all distances.
constexpr float kUnranked = -1.0F;

}  // namespace

bool WaitingSegments::has_changed_much(std::uint32_t segment, std::int64_t num_points) const {
  const auto known = examined_.find(segment);
  return known == examined_.end() || differ_much(known->second, num_points);
}

void WaitingSegments::add(std::uint32_t segment, std::int64_t num_points, std::int64_t utime,
                          bool is_urgent) {
  now_us_ = std::max(now_us_, utime);
  const auto [at, is_new] = waiting_.try_emplace(segment, Waiting{.since_us = utime});
  Waiting& waiting = at->second;
  if (is_new) std::get<std::int64_t>(waiting.place) = ++num_added_;
  waiting.num_points = num_points;
  const Turn before = is_new ? Turn::kOther : std::get<Turn>(waiting.place);
  if (num_points == 0) {
    put(segment, waiting, Turn::kFirst, kUnranked);
  } else if (is_urgent || before == Turn::kFirst) {
    put(segment, waiting, Turn::kFirst, 0.0F);
  } else if (before == Turn::kChangedMuch || has_changed_much(segment, num_points)) {
    const bool is_ranked = before == Turn::kChangedMuch && !unranked_.contains(segment) &&
                           !differ_much(waiting.num_ranked, num_points);
    if (is_ranked) return;
    put(segment, waiting, Turn::kChangedMuch, kUnranked);
    unranked_.insert(segment);
  } else {
    put(segment, waiting, Turn::kOther, 0.0F);
  }
}

/// Keeps when it came.
void WaitingSegments::put(std::uint32_t segment, Waiting& waiting, Turn turn, float distance) {
  in_order_.erase(waiting.place);
  unranked_.erase(segment);
  std::get<Turn>(waiting.place) = turn;
  std::get<float>(waiting.place) = distance;
  in_order_.emplace(waiting.place, segment);
}

std::vector<std::uint32_t> WaitingSegments::unranked() const {
  return {unranked_.begin(), unranked_.end()};
}

void WaitingSegments::rank(std::uint32_t segment, float distance) {
  Waiting& waiting = waiting_.at(segment);
  waiting.num_ranked = waiting.num_points;
  put(segment, waiting, Turn::kChangedMuch, distance);
}

void WaitingSegments::hurry(std::uint32_t segment) {
  const auto at = waiting_.find(segment);
  if (at == waiting_.end() || std::get<Turn>(at->second.place) == Turn::kFirst) return;
  put(segment, at->second, Turn::kFirst, 0.0F);
}

/// Of 1 and more: it has waited too long.
double WaitingSegments::impatience(const Waiting& waiting) const {
  const Turn turn = std::get<Turn>(waiting.place);
  if (turn == Turn::kFirst) return 0.0;
  const std::int64_t patience_us = turn == Turn::kOther ? kPatience_us : kLongPatience_us;
  return static_cast<double>(now_us_ - waiting.since_us) / static_cast<double>(patience_us);
}

std::uint32_t WaitingSegments::next() const {
  const std::uint32_t first = in_order_.begin()->second;
  if (was_turn_of_others_) return first;
  const auto longest = std::ranges::max_element(
      waiting_, {}, [this](const auto& entry) { return impatience(entry.second); });
  return impatience(longest->second) >= 1.0 ? longest->first : first;
}

WaitingSegments::Next WaitingSegments::pop() {
  const std::uint32_t segment = next();
  const Waiting waiting = waiting_.at(segment);
  was_turn_of_others_ =
      segment != in_order_.begin()->second || std::get<Turn>(waiting.place) == Turn::kOther;
  if (waiting.num_points > 0) {
    examined_[segment] = waiting.num_points;
  } else {
    examined_.erase(segment);
  }
  in_order_.erase(waiting.place);
  unranked_.erase(segment);
  waiting_.erase(segment);
  return {.segment = segment, .since_us = waiting.since_us};
}

void WaitingSegments::erase(std::uint32_t segment) {
  examined_.erase(segment);
  const auto at = waiting_.find(segment);
  if (at == waiting_.end()) return;
  in_order_.erase(at->second.place);
  unranked_.erase(segment);
  waiting_.erase(at);
}

void WaitingSegments::clear() {
  waiting_.clear();
  in_order_.clear();
  unranked_.clear();
  examined_.clear();
}

}  // namespace kintsugi::segmenter
