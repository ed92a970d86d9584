#pragma once

#include <array>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "mapper/openni2_driver/recording/recording.hpp"

namespace kintsugi::mapper {

enum class StreamKind : std::uint8_t { kDepth = 0, kColor = 1 };
inline constexpr std::size_t kNumStreamKinds = 2;

struct PlayedFrame {
  StreamKind kind = StreamKind::kDepth;
  int number = 0;              ///< in its stream, from 1, continued over repeats
  std::int64_t utime = 0;      ///< time stamp of the device
  std::int64_t due_utime = 0;  ///< when it is played, in the time of the recording
  cv::Mat image;               ///< CV_16UC1 or CV_8UC3 (red first)
};

/// Plays the frames of a recording in the order of their times, in its own thread.
///
/// Speed: 1 is real time, 2 twice as fast, 0 as fast as possible. With a negative speed one frame
/// is played for each trigger(). This is how OpenNI2 reads a file without loss: its core triggers
/// when a reader waits and there is no frame. The next frame is decoded in advance.
///
/// An image that cannot be read is passed over. It is the end when this happens to every image of
/// the depth stream (of the colour stream when that one alone is started).
class Playback {
 public:
  struct Callbacks {
    /// Returns false when the frame was not delivered, so that the next one is played at once.
    std::function<bool(const PlayedFrame&)> frame;
    /// An image that cannot be read is passed over, for this reason.
    std::function<void(StreamKind, const std::string&)> unread;
    /// Called after the last frame with an empty text, or with the reason when there is none.
    std::function<void(const std::string&)> end;
  };

  /// The recording must outlive the playback. Callbacks are called from the playing thread.
  Playback(Recording& recording, Callbacks callbacks);
  ~Playback();
  Playback(const Playback&) = delete;
  Playback& operator=(const Playback&) = delete;

  /// Starts a stream; frames of streams that are not started are skipped. After the end, starting
  /// the first stream plays the recording again from its beginning.
  void start(StreamKind kind);

  /// Stops a stream, and returns when none of its frames is being delivered.
  void stop(StreamKind kind);

  void trigger();

  /// Stops playing without calling Callbacks::end. May be called from a callback.
  void halt();

  void set_speed(float speed);
  [[nodiscard]] float speed() const;
  void set_repeat(bool repeat);
  [[nodiscard]] bool repeat() const;
  void set_depth_unit(DepthUnit unit);

 private:
  using Clock = std::chrono::steady_clock;

  /// One frame of the recording.
  struct Item {
    std::int64_t due_utime = 0;  ///< when it is to be played, in the recording's time
    StreamKind kind = StreamKind::kDepth;
    int index = 0;

    bool operator==(const Item&) const = default;
  };
  struct Decoded {
    Item item;
    DepthUnit unit = DepthUnit::k1mm;
    cv::Mat image;
  };
  /// What became of the images of one stream, since the beginning.
  struct Reading {
    bool any_read = false;
    std::string first_failure;  ///< empty: none failed
  };
  using Lock = std::unique_lock<std::mutex>;

  void run();
  void play_next(Lock& lock);
  bool wait_for_turn(Lock& lock);
  [[nodiscard]] std::optional<std::size_t> next_position() const;
  [[nodiscard]] bool any_running() const;
  [[nodiscard]] Clock::time_point due_time(const Item& item);
  [[nodiscard]] PlayedFrame describe(const Item& item, std::int64_t repeats) const;
  [[nodiscard]] std::string failure_of_all() const;
  bool read(const Item& item, DepthUnit unit, cv::Mat& image, std::string& failure);
  [[nodiscard]] cv::Mat decode(const Item& item, DepthUnit unit);
  void decode_ahead(Lock& lock);
  void finish(Lock& lock, const std::string& error);
  void rewind();

  Recording& recording_;
  const Callbacks callbacks_;
  const std::vector<Item> items_;  ///< by due time; colour first where equal
  std::optional<Decoded> ahead_;   ///< used by the playing thread only

  mutable std::mutex mutex_;
  std::condition_variable changed_;  ///< any of the state below
  std::array<bool, kNumStreamKinds> running_{};
  float speed_ = 1.0F;
  bool repeat_ = true;
  DepthUnit unit_ = DepthUnit::k1mm;
  bool triggered_ = false;
  bool in_flight_ = false;
  bool ended_ = false;
  bool quit_ = false;
  std::array<Reading, kNumStreamKinds> readings_{};
  std::size_t position_ = 0;  ///< of the next item to consider
  std::int64_t repeats_ = 0;
  std::optional<Clock::time_point> time_zero_;  ///< when an item of utime_zero_ was due
  std::int64_t utime_zero_ = 0;
  std::thread thread_;
};

}  // namespace kintsugi::mapper
