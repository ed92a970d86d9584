#include "lcmtypes/sequence_set.hpp"

#include <algorithm>
#include <iterator>

namespace kintsugi {

SequenceSet::Ranges::const_iterator SequenceSet::reaching(std::int64_t number) const {
  const auto above = ranges_.upper_bound(number);
  if (above == ranges_.begin()) return above;
  const auto below = std::prev(above);
  return below->second >= number ? below : above;
}

bool SequenceSet::contains(std::int64_t number) const {
  const auto range = reaching(number);
  return range != ranges_.end() && range->first <= number;
}

bool SequenceSet::insert(std::int64_t number) {
  if (contains(number)) return false;
  insert({number, number});
  return true;
}

void SequenceSet::insert(SequenceRange range) {
  // From the first range that touches it to the last one.
  auto touching = reaching(range.first - 1);
  while (touching != ranges_.end() && touching->first <= range.last + 1) {
    range.first = std::min(range.first, touching->first);
    range.last = std::max(range.last, touching->second);
    touching = ranges_.erase(touching);
  }
  ranges_.emplace_hint(touching, range.first, range.last);
}

void SequenceSet::erase(std::int64_t number) {
  const auto range = reaching(number);
  if (range == ranges_.end() || range->first > number) return;
  const auto [first, last] = *range;
  ranges_.erase(range);
  if (first < number) ranges_[first] = number - 1;
  if (number < last) ranges_[number + 1] = last;
}

std::vector<SequenceRange> SequenceSet::missing(std::int64_t begin, std::int64_t end,
                                                std::size_t max_ranges) const {
  std::vector<SequenceRange> gaps;
  std::int64_t next = begin;
  for (auto range = reaching(begin); range != ranges_.end() && range->first < end; ++range) {
    if (gaps.size() == max_ranges) return gaps;
    if (next < range->first) gaps.push_back({next, range->first - 1});
    next = range->second + 1;
  }
  if (next < end && gaps.size() < max_ranges) gaps.push_back({next, end - 1});
  return gaps;
}

std::int64_t SequenceSet::count_missing(std::int64_t begin, std::int64_t end) const {
  std::int64_t count = std::max<std::int64_t>(0, end - begin);
  for (auto range = reaching(begin); range != ranges_.end() && range->first < end; ++range) {
    count -= std::min(range->second, end - 1) - std::max(range->first, begin) + 1;
  }
  return count;
}

std::int64_t SequenceSet::lowest_missing(std::int64_t begin) const {
  const auto range = reaching(begin);
  return range != ranges_.end() && range->first <= begin ? range->second + 1 : begin;
}

std::vector<SequenceRange> SequenceSet::ranges() const {
  std::vector<SequenceRange> all;
  all.reserve(ranges_.size());
  for (const auto& [first, last] : ranges_) all.push_back({first, last});
  return all;
}

std::vector<SequenceRange> SequenceSet::ranges_from(std::int64_t begin,
                                                    std::size_t max_ranges) const {
  std::vector<SequenceRange> found;
  for (auto range = reaching(begin); range != ranges_.end() && found.size() < max_ranges; ++range) {
    found.push_back({std::max(range->first, begin), range->second});
  }
  return found;
}

}  // namespace kintsugi
