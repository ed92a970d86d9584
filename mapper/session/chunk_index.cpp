#include "mapper/session/chunk_index.hpp"

#include <algorithm>

namespace kintsugi::mapper {
namespace {

constexpr std::int32_t kWaitingFile = -1;  ///< instead of the number of a file
constexpr std::int32_t kMissingFile = -2;

}  // namespace

ChunkIndex::State ChunkIndex::state(std::int64_t sequence) const {
  const std::scoped_lock lock(mutex_);
  if (sequence < 0 || sequence >= std::ssize(places_)) return State::kMissing;
  const std::int32_t file = places_[static_cast<std::size_t>(sequence)].file;
  if (file == kWaitingFile) return State::kWaiting;
  return file < 0 ? State::kMissing : State::kWritten;
}

LogPlace ChunkIndex::place(std::int64_t sequence) const {
  const std::scoped_lock lock(mutex_);
  return places_.at(static_cast<std::size_t>(sequence));
}

void ChunkIndex::set_written(std::int64_t sequence, const LogPlace& place) { set(sequence, place); }

void ChunkIndex::set_waiting(std::int64_t sequence) { set(sequence, {kWaitingFile, 0, 0}); }

void ChunkIndex::set_missing(std::int64_t sequence) { set(sequence, {kMissingFile, 0, 0}); }

std::int64_t ChunkIndex::first() const {
  const std::scoped_lock lock(mutex_);
  const auto kept = [](const LogPlace& place) { return place.file != kMissingFile; };
  return std::ranges::find_if(places_, kept) - places_.begin();
}

std::int64_t ChunkIndex::end() const {
  const std::scoped_lock lock(mutex_);
  return std::ssize(places_);
}

void ChunkIndex::truncate_at_gap() {
  const std::scoped_lock lock(mutex_);
  places_.erase(std::ranges::find(places_, kMissingFile, &LogPlace::file), places_.end());
}

void ChunkIndex::truncate(std::int64_t sequence) {
  const std::scoped_lock lock(mutex_);
  if (sequence < std::ssize(places_)) places_.resize(static_cast<std::size_t>(sequence));
}

void ChunkIndex::set(std::int64_t sequence, const LogPlace& place) {
  const std::scoped_lock lock(mutex_);
  const auto index = static_cast<std::size_t>(sequence);
  if (index >= places_.size()) places_.resize(index + 1, {kMissingFile, 0, 0});
  places_[index] = place;
}

}  // namespace kintsugi::mapper
