#include "mapper/session/stored_stream.hpp"

#include <algorithm>
#include <exception>
#include <stdexcept>
#include <utility>

#include "mapper/session/session_log.hpp"

namespace kintsugi::mapper {
namespace {

constexpr std::int32_t kIsWaiting = -1;  ///< instead of a file
constexpr std::int32_t kIsMissing = -2;

}  // namespace

StoredStream::StoredStream(SessionLog& log, std::string channel)
    : log_(log), channel_(std::move(channel)) {}

void StoredStream::add(std::int64_t sequence, ByteView message) {
  const std::scoped_lock lock(log_.mutex_);
  if (sequence != static_cast<std::int64_t>(places_.size())) {
    throw std::invalid_argument("chunk " + std::to_string(sequence) + " of " + channel_ +
                                " for the log, expected " + std::to_string(places_.size()));
  }
  log_.append(channel_, message, this, sequence);
}

std::optional<Bytes> StoredStream::find(std::int64_t sequence) const {
  std::unique_lock lock(log_.mutex_);
  if (sequence < 0 || sequence >= static_cast<std::int64_t>(places_.size())) return {};
  const LogPlace place = places_[static_cast<std::size_t>(sequence)];
  if (place.file == kIsWaiting) {
    const auto waiting = std::ranges::find_if(log_.waiting_, [&](const auto& event) {
      return event.stream == this && event.sequence == sequence;
    });
    if (waiting == log_.waiting_.end()) return {};
    return waiting->data;
  }
  if (place.file < 0) return {};
  const LogWriter& file = log_.files_.file_of(place);
  lock.unlock();  // what is written stays as it is
  try {
    return file.read(place.offset, static_cast<std::size_t>(place.size));
  } catch (const std::exception&) {
    return {};
  }
}

std::int64_t StoredStream::first_sequence() const {
  const std::scoped_lock lock(log_.mutex_);
  const auto kept = [](const LogPlace& place) { return place.file != kIsMissing; };
  return std::ranges::find_if(places_, kept) - places_.begin();
}

std::int64_t StoredStream::next_sequence() const {
  const std::scoped_lock lock(log_.mutex_);
  return static_cast<std::int64_t>(places_.size());
}

void StoredStream::forget_behind_gap() {
  const std::scoped_lock lock(log_.mutex_);
  places_.erase(std::ranges::find(places_, kIsMissing, &LogPlace::file), places_.end());
}

void StoredStream::forget_from(std::int64_t sequence) {
  const std::scoped_lock lock(log_.mutex_);
  const auto index = static_cast<std::size_t>(sequence);
  if (index < places_.size()) places_.resize(index);
}

void StoredStream::set_place(std::int64_t sequence, const LogPlace& place) {
  this->place(sequence) = place;
}

void StoredStream::set_waiting(std::int64_t sequence) { place(sequence).file = kIsWaiting; }

void StoredStream::set_lost(std::int64_t sequence) { place(sequence).file = kIsMissing; }

LogPlace& StoredStream::place(std::int64_t sequence) {
  const auto index = static_cast<std::size_t>(sequence);
  if (index >= places_.size()) places_.resize(index + 1, {kIsMissing, 0, 0});
  return places_[index];
}

}  // namespace kintsugi::mapper
