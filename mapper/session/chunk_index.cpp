#include "mapper/session/chunk_index.hpp"

#include <algorithm>
#include <iterator>
#include <stdexcept>

namespace kintsugi::mapper {
namespace {

constexpr std::int32_t kWaitingFile = -1;  ///< instead of the number of a file

SequenceSet below(const SequenceSet& set, std::int64_t end) {
  SequenceSet result;
  for (const SequenceRange& range : set.ranges()) {
    if (range.first < end) result.insert({range.first, std::min(range.last, end - 1)});
  }
  return result;
}

}  // namespace

ChunkIndex::State ChunkIndex::state(std::int64_t sequence) const {
  const std::scoped_lock lock(mutex_);
  if (const LogPlace* const place = find(sequence)) {
    return place->file == kWaitingFile ? State::kWaiting : State::kWritten;
  }
  return fates_.replaced.contains(sequence) ? State::kReplaced : State::kMissing;
}

LogPlace ChunkIndex::place(std::int64_t sequence) const {
  const std::scoped_lock lock(mutex_);
  const LogPlace* const place = find(sequence);
  if (place == nullptr) throw std::out_of_range("a chunk that is not in the log");
  return *place;
}

ChunkFate ChunkIndex::fate(std::int64_t sequence) const {
  const std::scoped_lock lock(mutex_);
  if (fates_.superseded.contains(sequence)) return ChunkFate::kSuperseded;
  if (fates_.replaced.contains(sequence)) return ChunkFate::kReplaced;
  return fates_.changed.contains(sequence) ? ChunkFate::kChanged : ChunkFate::kKept;
}

std::vector<SequenceRange> ChunkIndex::replaced(std::int64_t begin, std::size_t max_ranges) const {
  const std::scoped_lock lock(mutex_);
  return fates_.replaced.ranges_from(begin, max_ranges);
}

void ChunkIndex::set_written(std::int64_t sequence, const LogPlace& place) {
  const std::scoped_lock lock(mutex_);
  set(sequence, place);
}

void ChunkIndex::set_waiting(std::int64_t sequence) {
  const std::scoped_lock lock(mutex_);
  set(sequence, {kWaitingFile, 0, 0});
}

void ChunkIndex::set_missing(std::int64_t sequence) {
  const std::scoped_lock lock(mutex_);
  const auto entry = lower_bound(sequence);
  if (entry != entries_.end() && entry->sequence == sequence) entries_.erase(entry);
  end_ = std::max(end_, sequence + 1);
}

void ChunkIndex::add_fates(const ChunkFates& fates) {
  const std::scoped_lock lock(mutex_);
  fates_.add(fates);
  for (const SequenceRange& range : fates.replaced.ranges()) end_ = std::max(end_, range.last + 1);
}

void ChunkIndex::move(std::int32_t last_file, const std::vector<Entry>& kept,
                      const ChunkFates& fates) {
  const std::scoped_lock lock(mutex_);
  std::deque<Entry> others;
  std::ranges::copy_if(entries_, std::back_inserter(others), [&](const Entry& entry) {
    return entry.place.file == kWaitingFile || entry.place.file > last_file;
  });
  entries_.clear();
  // What was written again later, after a gap, counts.
  std::ranges::set_union(others, kept, std::back_inserter(entries_), {}, &Entry::sequence,
                         &Entry::sequence);
  fates_ = fates;
  for (const Entry& entry : others) fates_.replaced.erase(entry.sequence);
}

std::int64_t ChunkIndex::first() const {
  const std::scoped_lock lock(mutex_);
  std::int64_t first = entries_.empty() ? end_ : entries_.front().sequence;
  for (const SequenceRange& range : fates_.replaced.ranges_from(0, 1)) {
    first = std::min(first, range.first);
  }
  return first;
}

std::int64_t ChunkIndex::end() const {
  const std::scoped_lock lock(mutex_);
  return end_;
}

void ChunkIndex::truncate_at_gap() {
  const std::scoped_lock lock(mutex_);
  SequenceSet there = fates_.replaced;
  for (const Entry& entry : entries_) there.insert(entry.sequence);
  forget_from(there.lowest_missing(0));
}

void ChunkIndex::truncate(std::int64_t sequence) {
  const std::scoped_lock lock(mutex_);
  forget_from(sequence);
}

void ChunkIndex::forget_from(std::int64_t sequence) {
  if (sequence >= end_) return;
  entries_.erase(lower_bound(sequence), entries_.end());
  for (SequenceSet* const set : {&fates_.replaced, &fates_.superseded, &fates_.changed}) {
    *set = below(*set, sequence);
  }
  end_ = sequence;
}

void ChunkIndex::set(std::int64_t sequence, const LogPlace& place) {
  const auto entry = lower_bound(sequence);
  if (entry != entries_.end() && entry->sequence == sequence) {
    entry->place = place;
  } else {
    entries_.insert(entry, {sequence, place});
  }
  end_ = std::max(end_, sequence + 1);
  if (!fates_.replaced.contains(sequence)) return;
  fates_.replaced.erase(sequence);  // it was lost, and is made again
  fates_.superseded.erase(sequence);
}

std::deque<ChunkIndex::Entry>::iterator ChunkIndex::lower_bound(std::int64_t sequence) {
  return std::ranges::lower_bound(entries_, sequence, {}, &Entry::sequence);
}

const LogPlace* ChunkIndex::find(std::int64_t sequence) const {
  const auto entry = std::ranges::lower_bound(entries_, sequence, {}, &Entry::sequence);
  return entry != entries_.end() && entry->sequence == sequence ? &entry->place : nullptr;
}

}  // namespace kintsugi::mapper
