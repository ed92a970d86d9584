#pragma once
// What the cameras of a map on the bus saw, as its segmenter has recorded it.

#include <chrono>
#include <cstdint>
#include <functional>
#include <future>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "lcmtypes/messages.hpp"
#include "segmenter/objects/detection/detector.hpp"
#include "segmenter/views/map_view.hpp"

namespace kintsugi::segmenter {

/// Asks the segmenter again and again, and tells a detector. While the map grows, for what was seen
/// since the last answer, and at times for everything: corrections of the map move views, and the
/// segmenter thins them out (ViewRecord). When the map has ended, once more for everything, since
/// what is detected in the end must not depend on when views came. Then it asks some times before
/// it gives up. Requests are made in a thread of their own, because an answer takes up to some
/// seconds.
class FollowedViews {
 public:
  using Clock = std::chrono::steady_clock;

  struct Request {
    std::int64_t map_session = 0;  // of the mapper
    std::int64_t since_us = 0;     // only views taken then or later, device time; 0: all

    bool operator==(const Request&) const = default;
  };
  struct Answer {
    Request request{};
    std::vector<MapView> views{};  // by ascending time, where corrections have put them
    std::string problem{};         // why there are no further ones; empty: these are all
  };
  /// Called in another thread. Must not throw.
  using Ask = std::function<Answer(const Request&)>;

  explicit FollowedViews(Ask ask) : ask_(std::move(ask)) {}

  /// Asks the segmenter on a bus. @param lcm_url of the bus; empty: the default one
  static Ask of_segmenter(std::string lcm_url);

  /// Another map, or another detector, which knows of no views.
  void begin(std::int64_t map_session);
  /// A correction has moved pieces of the map, and with them what the cameras saw.
  /// @param now never goes back
  void note_correction(Clock::time_point now = Clock::now());
  /// The map was about to end, and goes on.
  void go_on();
  /// To be called regularly. @param now never goes back
  /// @return whether the detector was told something else than it knew
  bool update(bool map_has_ended, Detector& detector, Clock::time_point now = Clock::now());
  /// An answer is on its way.
  [[nodiscard]] bool is_asking() const { return running_.valid(); }
  /// The detector has all views of a map that has ended, or nobody tells them.
  [[nodiscard]] bool are_complete() const { return end_.is_told; }
  /// Why the detector does not have all views of a map that has ended; empty: it has, or may yet.
  [[nodiscard]] const std::string& problem() const { return problem_; }

 private:
  bool use(const Answer& answer, Detector& detector, Clock::time_point now);
  void give_up(const std::string& reason);

  Ask ask_;
  Request next_;
  Clock::time_point due_{};
  bool is_corrected_ = false;      // since everything was asked for
  Clock::time_point whole_due_{};  // not before, everything again
  struct {
    bool is_asked = false;  // for all views
    bool is_told = false;
    int num_failures = 0;
  } end_;
  std::string problem_;
  bool has_warned_ = false;
  std::future<Answer> running_;  // last: it is waited for before the others end
};

/// Whether a correction has moved a piece: its points are elsewhere, and nothing else about them
/// has changed.
bool is_moved(std::span<const CloudPoint> before_W, std::span<const CloudPoint> now_W);

}  // namespace kintsugi::segmenter
