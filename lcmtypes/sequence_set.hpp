#pragma once
// A set of sequence numbers.

#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

#include "lcmtypes/messages.hpp"

namespace kintsugi {

/// A set of numbers >= 0, stored as disjoint ranges: it is small if there are few gaps.
class SequenceSet {
 public:
  /// Returns false if `number` is in the set already.
  bool insert(std::int64_t number);
  /// `range.first` <= `range.last`.
  void insert(SequenceRange range);
  void erase(std::int64_t number);
  bool contains(std::int64_t number) const;

  /// The numbers in [begin, end) that are not in the set: the lowest `max_ranges` ranges of them.
  std::vector<SequenceRange> missing(std::int64_t begin, std::int64_t end,
                                     std::size_t max_ranges) const;
  std::int64_t count_missing(std::int64_t begin, std::int64_t end) const;
  /// The lowest number >= `begin` that is not in the set.
  std::int64_t lowest_missing(std::int64_t begin) const;

  std::vector<SequenceRange> ranges() const;
  /// The part of the set from `begin` on: the lowest `max_ranges` ranges of it.
  std::vector<SequenceRange> ranges_from(std::int64_t begin, std::size_t max_ranges) const;
  std::size_t num_ranges() const { return ranges_.size(); }

 private:
  using Ranges = std::map<std::int64_t, std::int64_t>;  // first -> last, inclusive

  /// The first range that ends at `number` or above.
  Ranges::const_iterator reaching(std::int64_t number) const;

  Ranges ranges_;
};

}  // namespace kintsugi
