#include "mapper/openni2_driver/plugin/playback.hpp"

#include <algorithm>
#include <exception>
#include <tuple>
#include <utility>

namespace kintsugi::mapper {
namespace {

std::size_t slot(StreamKind kind) { return static_cast<std::size_t>(kind); }

}  // namespace

Playback::Playback(Recording& recording, Callbacks callbacks)
    : recording_(recording), callbacks_(std::move(callbacks)), items_([&] {
        std::vector<Item> items;
        items.reserve(static_cast<std::size_t>(recording.num_depth_frames()) +
                      static_cast<std::size_t>(recording.num_color_frames()));
        for (int i = 0; i < recording.num_depth_frames(); ++i) {
          items.push_back({recording.depth_utime(i), StreamKind::kDepth, i});
        }
        for (int i = 0; i < recording.num_color_frames(); ++i) {
          items.push_back(
              {recording.color_utime(i) + recording.color_delay_us(), StreamKind::kColor, i});
        }
        std::ranges::sort(items, [](const Item& a, const Item& b) {
          return std::tuple(a.due_utime, b.kind) < std::tuple(b.due_utime, a.kind);
        });
        return items;
      }()) {
  thread_ = std::thread([this] { run(); });
}

Playback::~Playback() {
  {
    const Lock lock(mutex_);
    quit_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void Playback::start(StreamKind kind) {
  {
    const Lock lock(mutex_);
    if (!any_running()) {
      time_zero_.reset();
      triggered_ = false;
      if (ended_) rewind();
    }
    running_.at(slot(kind)) = true;
  }
  changed_.notify_all();
}

void Playback::stop(StreamKind kind) {
  Lock lock(mutex_);
  running_.at(slot(kind)) = false;
  changed_.wait(lock, [this] { return !in_flight_; });
}

void Playback::trigger() {
  {
    const Lock lock(mutex_);
    triggered_ = true;
  }
  changed_.notify_all();
}

void Playback::halt() {
  {
    const Lock lock(mutex_);
    ended_ = true;
  }
  changed_.notify_all();
}

void Playback::set_speed(float speed) {
  {
    const Lock lock(mutex_);
    speed_ = speed;
    time_zero_.reset();
  }
  changed_.notify_all();
}

float Playback::speed() const {
  const Lock lock(mutex_);
  return speed_;
}

void Playback::set_repeat(bool repeat) {
  {
    const Lock lock(mutex_);
    repeat_ = repeat;
  }
  changed_.notify_all();
}

bool Playback::repeat() const {
  const Lock lock(mutex_);
  return repeat_;
}

void Playback::set_depth_unit(DepthUnit unit) {
  const Lock lock(mutex_);
  unit_ = unit;
}

void Playback::run() {
  Lock lock(mutex_);
  while (wait_for_turn(lock)) {
    try {
      play_next(lock);
      decode_ahead(lock);
    } catch (const std::exception& error) {
      if (!lock.owns_lock()) lock.lock();
      in_flight_ = false;
      changed_.notify_all();
      finish(lock, error.what());
    }
  }
}

/// Until there is something to play and its time has come; false: quit.
bool Playback::wait_for_turn(Lock& lock) {
  while (!quit_) {
    const auto next = next_position();
    if (ended_ || !any_running()) {
      changed_.wait(lock);
    } else if (!next && !failure_of_all().empty()) {
      finish(lock, failure_of_all());
    } else if (!next && repeat_) {
      position_ = 0;
      ++repeats_;
      time_zero_.reset();
    } else if (!next) {
      finish(lock, "");
    } else if (speed_ < 0.0F) {
      if (std::exchange(triggered_, false)) return true;
      changed_.wait(lock);
    } else {
      const auto due = due_time(items_[*next]);
      if (Clock::now() >= due) return true;
      changed_.wait_until(lock, due);
    }
  }
  return false;
}

void Playback::play_next(Lock& lock) {
  const std::size_t position = *next_position();
  const Item item = items_[position];
  const DepthUnit unit = unit_;
  position_ = position + 1;
  in_flight_ = true;
  const std::int64_t repeats = repeats_;
  lock.unlock();

  PlayedFrame frame = describe(item, repeats);
  std::string failure;
  bool delivered = false;
  if (read(item, unit, frame.image, failure)) {
    // OpenNI2's core may poke more than once while it waits for this one frame. A trigger kept from
    // before would release the next frame too, and replace this one before it is read.
    {
      const Lock clear(mutex_);
      triggered_ = false;
    }
    delivered = callbacks_.frame(frame);
  } else {
    callbacks_.unread(item.kind, failure);
  }

  lock.lock();
  Reading& reading = readings_.at(slot(item.kind));
  if (failure.empty()) reading.any_read = true;
  if (reading.first_failure.empty()) reading.first_failure = failure;
  in_flight_ = false;
  if (!delivered) triggered_ = true;
  changed_.notify_all();
}

/// All but the image.
PlayedFrame Playback::describe(const Item& item, std::int64_t repeats) const {
  const bool is_depth = item.kind == StreamKind::kDepth;
  const auto count = static_cast<std::int64_t>(is_depth ? recording_.num_depth_frames()
                                                        : recording_.num_color_frames());
  const std::int64_t period_us = 1'000'000 / recording_.frame_rate_hz();
  const std::int64_t length_us = items_.back().due_utime - items_.front().due_utime + period_us;
  const std::int64_t stamp =
      is_depth ? recording_.depth_stamp(item.index) : recording_.color_stamp(item.index);
  return {.kind = item.kind,
          .number = static_cast<int>(repeats * count + item.index + 1),
          .utime = stamp + repeats * length_us,
          .due_utime = item.due_utime + repeats * length_us,
          .image = {}};
}

/// Why nothing came of the stream that matters; empty: something did.
std::string Playback::failure_of_all() const {
  const bool has_depth = running_.at(slot(StreamKind::kDepth));
  const Reading& reading = readings_.at(slot(has_depth ? StreamKind::kDepth : StreamKind::kColor));
  if (reading.any_read || reading.first_failure.empty()) return "";
  return std::string("no ") + (has_depth ? "depth" : "colour") +
         " image of the recording can be read; the first: " + reading.first_failure;
}

/// The first item, from position_ on, of a stream that runs.
std::optional<std::size_t> Playback::next_position() const {
  const auto it =
      std::find_if(items_.begin() + static_cast<std::ptrdiff_t>(position_), items_.end(),
                   [this](const Item& item) { return running_.at(slot(item.kind)); });
  if (it == items_.end()) return std::nullopt;
  return static_cast<std::size_t>(it - items_.begin());
}

bool Playback::any_running() const {
  return std::ranges::any_of(running_, [](bool running) { return running; });
}

Playback::Clock::time_point Playback::due_time(const Item& item) {
  // When reading or the reader is too slow, the playback becomes slower: it does not catch up.
  constexpr auto kTolerance = std::chrono::milliseconds(100);
  const auto now = Clock::now();
  if (speed_ == 0.0F) return now;
  if (!time_zero_) {
    time_zero_ = now;
    utime_zero_ = item.due_utime;
  }
  const auto elapsed_us = static_cast<double>(item.due_utime - utime_zero_) / speed_;
  const auto due = *time_zero_ + std::chrono::microseconds(static_cast<std::int64_t>(elapsed_us));
  if (now > due + kTolerance) {
    time_zero_ = now;
    utime_zero_ = item.due_utime;
    return now;
  }
  return due;
}

/// False: `failure` tells why.
bool Playback::read(const Item& item, DepthUnit unit, cv::Mat& image, std::string& failure) {
  try {
    image = decode(item, unit);
    return true;
  } catch (const std::exception& error) {
    failure = error.what();
    return false;
  }
}

cv::Mat Playback::decode(const Item& item, DepthUnit unit) {
  if (ahead_ && ahead_->item == item && ahead_->unit == unit) {
    return std::exchange(ahead_, std::nullopt)->image;
  }
  if (item.kind == StreamKind::kDepth) return recording_.depth(item.index, unit);
  return recording_.color(item.index);
}

void Playback::decode_ahead(Lock& lock) {
  const auto next = next_position();
  if (!next || quit_) return;
  const Item item = items_[*next];
  const DepthUnit unit = unit_;
  lock.unlock();
  try {
    ahead_ = Decoded{.item = item, .unit = unit, .image = decode(item, unit)};
  } catch (const std::exception&) {
    ahead_.reset();  // it fails again, and is passed over, when its turn comes
  }
  lock.lock();
}

void Playback::finish(Lock& lock, const std::string& error) {
  ended_ = true;
  lock.unlock();
  callbacks_.end(error);
  lock.lock();
}

void Playback::rewind() {
  ended_ = false;
  position_ = 0;
  repeats_ = 0;
  readings_ = {};
}

}  // namespace kintsugi::mapper
