#pragma once
// Finds the objects of a library in a map while it grows, and tells what becomes of them.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "lcmtypes/object_messages.hpp"
#include "segmenter/objects/detection/recognitions.hpp"
#include "segmenter/objects/detection/waiting_segments.hpp"
#include "segmenter/objects/recognition/object_recognizer.hpp"
#include "segmenter/objects/recognition/scene.hpp"
#include "segmenter/views/map_view.hpp"
#include "segmenter/views/observed_space.hpp"

namespace kintsugi::segmenter {

/// One object in the map. Of two robots' worth of the same thing there are two detections.
struct Detection {
  std::int32_t number = 0;                        ///< from 1
  Recognition recognition;                        ///< when gone, the last one
  DetectionEvent event = DetectionEvent::kFound;  ///< the last one
  std::int64_t event_number = 0;                  ///< ascending over all detections, from 1
  std::int64_t change_number = 0;  ///< the same, also of new poses and segments without an event
  std::int64_t event_utime = 0;    ///< device time of the map at the event, microseconds
  std::int64_t found_utime = 0;    ///< the same when it was found where it is
};

/// Pieces of the map come with set_piece(); segments that changed wait until examine_next() has
/// looked at them, in the order of WaitingSegments. When none waits, the detections that are
/// not gone are a function of the map and the library alone if examine_all() was called after the
/// last change.
class Detector {
 public:
  /// @param recognizer of the objects, for the resolution of the map
  /// @param map_session of its mapper; 0: not known
  explicit Detector(std::shared_ptr<const ObjectRecognizer> recognizer,
                    std::int64_t map_session = 0);
  /// @param resolution_m voxel size of the map, > 0
  Detector(std::vector<ObjectModel> models, float resolution_m, std::int64_t map_session = 0);
  Detector(const Detector&) = delete;  // its parts refer to each other
  Detector& operator=(const Detector&) = delete;

  /// Adds or replaces a piece of the map (LabelledMap::set_piece()).
  /// @param utime device time of the map then, microseconds
  void set_piece(std::int32_t id, LabelledMap::Points points_W,
                 std::vector<std::uint32_t> segment_ids, std::int64_t utime);
  /// What the cameras of the map saw. It counts for what is examined from now on.
  /// @return whether it is something else than before
  bool set_views(std::span<const MapView> views);
  /// What they saw meanwhile.
  void add_views(std::span<const MapView> views);
  [[nodiscard]] std::size_t num_views() const { return observed_.views().size(); }
  /// Lets all segments wait: what depends on the whole map may have changed, also its light.
  /// Nothing is told before the light is known, or before it is certain, and nothing is gone before
  /// all was examined.
  void examine_all();

  /// Examines the segment that waits and is next, and updates the detections.
  /// @return device time since which it has waited, microseconds; nothing: none waited
  std::optional<std::int64_t> examine_next();
  /// The same with several segments, on all cores. @return of the one that has waited longest
  std::optional<std::int64_t> examine_many();
  /// So many segments at most.
  [[nodiscard]] static std::size_t most_at_once();
  [[nodiscard]] std::size_t num_waiting() const { return waiting_.size(); }

  /// All detections, by number, gone ones included.
  [[nodiscard]] const std::vector<Detection>& detections() const { return detections_; }
  /// @param model as in Recognition
  [[nodiscard]] const ObjectModel& model(std::size_t model) const {
    return recognizer_->model(model);
  }
  [[nodiscard]] std::int64_t num_events() const { return num_events_; }
  [[nodiscard]] std::int64_t num_changes() const { return num_changes_; }
  [[nodiscard]] std::int64_t num_candidates() const { return recognitions_.num_candidates(); }
  [[nodiscard]] const LabelledMap& map() const { return scene_.map(); }

 private:
  void wait_for(std::uint32_t segment, bool is_urgent = false);
  void begin_again(const LightChange& light);
  [[nodiscard]] bool expects_light() const;
  void settle_light();
  void rank_waiting(bool on_all_cores);
  void examine(std::span<const std::uint32_t> segments);
  [[nodiscard]] bool follow(std::uint32_t segment);
  [[nodiscard]] std::vector<Detection>::const_iterator told_of(std::uint32_t segment) const;
  [[nodiscard]] Recognition followed(const Recognition& last) const;
  void hurry_what_decides(std::span<const std::uint32_t> examined);
  void update_detections();
  [[nodiscard]] std::vector<Recognition> certain() const;
  void confirm_old_ones();
  [[nodiscard]] Detection* same_place(const Recognition& recognition,
                                      const std::set<std::int32_t>& taken);
  [[nodiscard]] Detection* vanished(const Recognition& recognition,
                                    const std::set<std::int32_t>& kept);
  [[nodiscard]] double distance_m(const Detection& detection, const Recognition& recognition) const;
  [[nodiscard]] bool is_near(const Detection& detection, const Recognition& recognition) const;
  [[nodiscard]] std::set<std::uint32_t> segments_at(const Detection& detection) const;
  [[nodiscard]] bool is_waiting(const Recognition& recognition) const;
  [[nodiscard]] bool may_be_found_again(const Detection& detection) const;
  [[nodiscard]] bool is_undecided(const Detection& detection) const;
  [[nodiscard]] bool is_disputed(const Recognition& recognition,
                                 const std::set<std::int32_t>& kept) const;
  [[nodiscard]] bool is_still_there(Detection& detection, const std::vector<Recognition>& best);
  void tell(Detection& detection, DetectionEvent event);

  std::shared_ptr<const ObjectRecognizer> recognizer_;
  Scene scene_;
  ObservedSpace observed_;
  bool is_light_settled_ = false;
  bool is_light_expected_ = false;  // what is recognised may be told before all is examined
  bool is_checking_all_ = false;    // since examine_all(), until the map changes
  Recognitions recognitions_;
  WaitingSegments waiting_;
  std::vector<Detection> detections_;
  std::int64_t num_events_ = 0;
  std::int64_t num_changes_ = 0;
  std::int64_t utime_ = 0;
};

}  // namespace kintsugi::segmenter
