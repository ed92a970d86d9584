#pragma once
// Receives one map from any source of messages.

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "lcmtypes/client/event_table.hpp"
#include "lcmtypes/client/segment_listener.hpp"
#include "segmenter/library/bus.hpp"
#include "segmenter/library/followed_pieces.hpp"

namespace kintsugi::segmenter {

/// Chooses the map, and applies its slices, updates, camera poses and detections of objects.
class MapFollower {
 public:
  explicit MapFollower(const MapClientOptions& options);
  MapFollower(const MapFollower&) = delete;  // the subscribers call it
  MapFollower& operator=(const MapFollower&) = delete;

  /// From now on bus.handle() applies messages. This must outlive the last bus.handle().
  void subscribe(Bus& bus);
  /// Requests what is missing; `now_s` is the time of a PatientClock.
  void ask(Bus& bus, double now_s);
  /// Handles one message of a log, which was received at `now_s`; this never goes back.
  void handle(const std::string& channel, ByteView message, double now_s);

  /// What has changed since the last call.
  MapChanges take_changes();
  [[nodiscard]] bool has_changes() const;

  [[nodiscard]] const SegmentListener& segments() const { return listener_; }
  /// Points and labels of the map that is followed.
  [[nodiscard]] const FollowedPieces& pieces() const;
  /// Of the map that is followed; 0: no slice of it has come.
  [[nodiscard]] float resolution_m() const;
  [[nodiscard]] const std::optional<CameraPose>& camera() const { return camera_; }
  /// Those that are in the map that is followed, by ascending number.
  [[nodiscard]] std::vector<ObjectDetection> objects() const;
  /// No slice that is known of is missing, or it is not sent any more.
  [[nodiscard]] bool has_slices() const;
  /// What is missing, as text for a person; empty: nothing.
  [[nodiscard]] std::string problem() const;
  [[nodiscard]] std::string dropped() const;

 private:
  /// Of some minutes; other maps may have a camera, too.
  static constexpr std::size_t kMaxEarlyPoses = 10'000;

  struct Session {
    std::string map_name;
    float resolution_m = 0.0F;
    FollowedPieces pieces;
  };

  [[nodiscard]] std::int64_t current_session() const;
  [[nodiscard]] bool is_wanted(const CloudSlice& header) const;
  void use(CloudSlice slice);
  void use(const SegmentUpdate& update);
  void use(const CameraPose& pose);
  void use(const ObjectDetection& detection);
  void use(const DetectorStatus& status);
  [[nodiscard]] bool lacks_slices() const;
  void follow_current();
  void forget_others();

  const MapClientOptions options_;
  SegmentListener listener_;
  StreamSubscriber<CloudSlice> slices_;
  /// Of the mapper. As long as no update has told which map it is: of every map.
  std::map<std::int64_t, Session> sessions_;
  std::int64_t followed_session_ = 0;
  std::optional<CameraPose> camera_;
  /// Of sessions of which it is not known whether they are of the map: a pose does not name it.
  std::deque<CameraPose> early_poses_;
  ObjectTable objects_;
  double now_s_ = 0.0;
  MapChanges changes_;
  std::set<std::int32_t> changed_pieces_;
};

}  // namespace kintsugi::segmenter
