#include "lcmtypes/sequence_set.hpp"

#include <iterator>

namespace kintsugi {

bool SequenceSet::contains(std::int64_t number) const {
  const auto after = ranges_.upper_bound(number);
  return after != ranges_.begin() && std::prev(after)->second >= number;
}

bool SequenceSet::insert(std::int64_t number) {
  if (contains(number)) return false;
  std::int64_t first = number;
  std::int64_t last = number;
  const auto after = ranges_.find(number + 1);
  if (after != ranges_.end()) {
    last = after->second;
    ranges_.erase(after);
  }
  const auto upper = ranges_.upper_bound(number);
  if (upper != ranges_.begin() && std::prev(upper)->second == number - 1) {
    first = std::prev(upper)->first;
  }
  ranges_[first] = last;
  return true;
}

void SequenceSet::erase(std::int64_t number) {
  if (!contains(number)) return;
  const auto range = std::prev(ranges_.upper_bound(number));
  const auto [first, last] = *range;
  ranges_.erase(range);
  if (first < number) ranges_[first] = number - 1;
  if (number < last) ranges_[number + 1] = last;
}

std::vector<SequenceRange> SequenceSet::missing(std::int64_t end, std::size_t max_ranges) const {
  std::vector<SequenceRange> gaps;
  std::int64_t next = 0;
  for (const auto& [first, last] : ranges_) {
    if (next >= end || gaps.size() == max_ranges) return gaps;
    if (next < first) gaps.push_back({next, first - 1});
    next = last + 1;
  }
  if (next < end && gaps.size() < max_ranges) gaps.push_back({next, end - 1});
  return gaps;
}

std::int64_t SequenceSet::count_missing(std::int64_t end) const {
  std::int64_t seen = 0;
  for (const auto& [first, last] : ranges_) seen += last - first + 1;
  return end - seen;
}

std::int64_t SequenceSet::close_lowest_gap() {
  if (ranges_.empty()) return 0;
  const auto lowest = ranges_.begin();
  if (lowest->first > 0) {
    const auto [first, last] = *lowest;
    ranges_.erase(lowest);
    ranges_[0] = last;
    return first;
  }
  const auto next = std::next(lowest);
  if (next == ranges_.end()) return 0;
  const std::int64_t gap = next->first - lowest->second - 1;
  lowest->second = next->second;
  ranges_.erase(next);
  return gap;
}

}  // namespace kintsugi
