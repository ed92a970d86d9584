#pragma once
// Which numbers of a stream have been seen.

#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

#include "lcmtypes/messages.hpp"

namespace kintsugi {

/// A set of numbers >= 0, kept as disjoint ranges: small while a stream has few gaps.
class SequenceSet {
 public:
  /// False when `number` was there already.
  bool insert(std::int64_t number);
  void erase(std::int64_t number);
  bool contains(std::int64_t number) const;

  /// The numbers in [0, end) that are not there, as at most `max_ranges` ranges, lowest first.
  std::vector<SequenceRange> missing(std::int64_t end, std::size_t max_ranges) const;
  std::int64_t count_missing(std::int64_t end) const;

  std::size_t num_ranges() const { return ranges_.size(); }
  /// Fills the lowest gap above the first range, as though it had been seen; returns its size.
  std::int64_t close_lowest_gap();

 private:
  std::map<std::int64_t, std::int64_t> ranges_;  // first -> last, inclusive
};

}  // namespace kintsugi
