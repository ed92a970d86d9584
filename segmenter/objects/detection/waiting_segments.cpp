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

// As a distance: before all others.
constexpr float kBeforeAll = -1.0F;

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
    put(segment, waiting, Turn::kFirst, kBeforeAll);
  } else if (is_urgent || before == Turn::kFirst) {
    put(segment, waiting, Turn::kFirst, 0.0F);
  } else if (before == Turn::kChangedMuch || has_changed_much(segment, num_points)) {
    const bool is_ranked = before == Turn::kChangedMuch && !unranked_.contains(segment) &&
                           !differ_much(waiting.num_ranked, num_points);
    if (is_ranked) return;
    put(segment, waiting, Turn::kChangedMuch, kBeforeAll);
    unranked_.insert(segment);
  } else {
    put(segment, waiting, Turn::kOther, 0.0F);
  }
}

/// Keeps when it came.
void WaitingSegments::put(std::uint32_t segment, Waiting& waiting, Turn turn, float distance) {
  take_out_of_order(segment, waiting);
  std::get<Turn>(waiting.place) = turn;
  std::get<float>(waiting.place) = distance;
  in_order_.emplace(waiting.place, segment);
  as_they_came_.emplace(std::pair(turn, std::get<std::int64_t>(waiting.place)), segment);
}

void WaitingSegments::take_out_of_order(std::uint32_t segment, const Waiting& waiting) {
  const auto& [turn, distance, number] = waiting.place;
  in_order_.erase(waiting.place);
  as_they_came_.erase({turn, number});
  unranked_.erase(segment);
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

double WaitingSegments::impatience(Turn turn, std::int64_t patience_us) const {
  const auto first = as_they_came_.lower_bound({turn, 0});
  if (first == as_they_came_.end() || first->first.first != turn) return 0.0;
  const std::int64_t since_us = waiting_.at(first->second).since_us;
  return static_cast<double>(now_us_ - since_us) / static_cast<double>(patience_us);
}

std::uint32_t WaitingSegments::next() const {
  if (!was_turn_of_others_) {
    const double changed_much = impatience(Turn::kChangedMuch, kLongPatience_us);
    const double other = impatience(Turn::kOther, kPatience_us);
    if (std::max(changed_much, other) >= 1.0) {
      const Turn turn = other >= changed_much ? Turn::kOther : Turn::kChangedMuch;
      return as_they_came_.lower_bound({turn, 0})->second;
    }
  }
  return in_order_.begin()->second;
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
  take_out_of_order(segment, waiting);
  waiting_.erase(segment);
  return {.segment = segment, .since_us = waiting.since_us};
}

void WaitingSegments::erase(std::uint32_t segment) {
  examined_.erase(segment);
  const auto at = waiting_.find(segment);
  if (at == waiting_.end()) return;
  take_out_of_order(segment, at->second);
  waiting_.erase(at);
}

void WaitingSegments::clear() {
  waiting_.clear();
  in_order_.clear();
  as_they_came_.clear();
  unranked_.clear();
  examined_.clear();
}

}  // namespace kintsugi::segmenter
