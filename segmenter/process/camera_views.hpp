#pragma once
// What the cameras of the maps see now.

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>

#include "lcmtypes/bus/bus.hpp"
#include "lcmtypes/stream/stream_subscriber.hpp"

namespace kintsugi::segmenter {

/// Keeps the newest view of each map session. Views come ten times a second; one that is two
/// seconds old does not show what the camera sees now.
class CameraViews {
 public:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::seconds kMaxAge{2};

  /// @param on_view called with each view that is received, before add(); may be empty
  explicit CameraViews(std::function<void(const CameraView&)> on_view = {});

  /// From now on bus.handle() receives views; this must outlive that.
  void subscribe(Bus& bus) { stream_.subscribe(bus); }

  /// The newest view of a map session, without its colours; null when none has come for kMaxAge, or
  /// when it does not show where the camera is, because tracking is lost.
  std::shared_ptr<const CameraView> newest(std::int64_t map_session) const;

  std::int64_t messages_bad() const { return stream_.counts().messages_bad; }

  /// Of any map; at most so many sessions are kept, the newest.
  void add(CameraView view, Clock::time_point now);

 private:
  struct Received {
    std::shared_ptr<const CameraView> view;
    Clock::time_point time;
  };

  mutable std::mutex mutex_;  // guards the next
  std::map<std::int64_t, Received> by_session_;
  StreamSubscriber<CameraView> stream_;
};

}  // namespace kintsugi::segmenter
