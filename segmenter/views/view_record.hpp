#pragma once
// Which views of the camera are kept of a map session.

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "lcmtypes/messages.hpp"
#include "lcmtypes/patch_motions.hpp"
#include "segmenter/map/segment_map.hpp"
#include "segmenter/views/kept_view.hpp"

namespace kintsugi::segmenter {

/// Keeps a thinned set of the views of one map session, and moves them when the map is corrected.
///
/// A view is kept when the camera has moved or turned since the one before by kShare of what it
/// sees, so that a place is in about ten views, whose votes count against each other; and after
/// kRevisit_s in any case, because meanwhile something may have changed. A view of 160 x 120
/// samples takes about 17 KB: a Kinect's noise hardly compresses. Beyond kMaxViews that view is
/// given up whose neighbours in time are nearest to each other in place and time: they have shown
/// nearly the same, at nearly the same time.
///
/// Corrections: the pose of a view is in W as of its frame. It hangs on the patch whose header came
/// last before that frame, of the same camera and part of the map, with the corrections up to that
/// frame; so views wait for a slice that is later than they are. Slices come a little later than
/// views, and in their order but for losses.
class ViewRecord {
 public:
  static constexpr double kShare = 0.08;
  static constexpr double kRevisit_s = 30.0;
  static constexpr std::size_t kMaxViews = 2'000;

  ViewRecord(std::int64_t map_session, std::string map_name);
  /// Continues that of a saved map.
  ViewRecord(ViewSet saved, const SegmentMap& map);

  /// A view of the session, in order of time: others are left out, as are those of a camera that is
  /// lost.
  void add(const CameraView& view);
  /// What the header of a slice of the session tells, or a correction.
  void add(const CloudSlice& slice);

  /// What `later` was told of the same session while this one was read from a file.
  void append(const ViewRecord& later);

  /// The views that are kept, with their poses as of now.
  [[nodiscard]] ViewSet views() const;

  /// Where a patch is by what was told so far.
  [[nodiscard]] std::optional<PatchPlace> place_of(std::int32_t patch) const;

 private:
  [[nodiscard]] bool is_news(const KeptView& view, double scene_m) const;
  void hang_up(KeptView& view) const;
  void thin_out();

  ViewSet set_;
  std::int64_t last_utime_ = -1;                     // of the views that came
  std::map<std::int32_t, PatchPlace> headers_;       // of the newest revision of each slice
  std::map<std::int32_t, std::int32_t> last_patch_;  // of each part
  PatchMotions motions_;
};

/// How much of the camera's view is another one at a pose than at another: 0 the same, 1 about all
/// of it. @param scene_m typical depth of what is seen
double view_change(const Intrinsics& camera, double scene_m, const Pose& X_WA, const Pose& X_WB);

}  // namespace kintsugi::segmenter
