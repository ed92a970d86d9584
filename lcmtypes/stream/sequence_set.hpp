#pragma once
// A set of the numbers of a stream.

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
  /// `range.first` <= `range.last`.
  void insert(SequenceRange range);
  void erase(std::int64_t number);
  bool contains(std::int64_t number) const;

  /// The numbers in [begin, end) that are not there, as at most `max_ranges` ranges, lowest first.
  std::vector<SequenceRange> missing(std::int64_t begin, std::int64_t end,
                                     std::size_t max_ranges) const;
  std::int64_t count_missing(std::int64_t begin, std::int64_t end) const;
  /// The lowest number >= `begin` that is not there.
  std::int64_t lowest_missing(std::int64_t begin) const;

  std::vector<SequenceRange> ranges() const;
  std::size_t num_ranges() const { return ranges_.size(); }

 private:
  using Ranges = std::map<std::int64_t, std::int64_t>;  // first -> last, inclusive

  /// The first range that ends at `number` or above.
  Ranges::const_iterator reaching(std::int64_t number) const;

  Ranges ranges_;
};

}  // namespace kintsugi
