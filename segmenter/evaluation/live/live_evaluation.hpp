#pragma once
// How much of what the camera sees is in the segment map, and how soon.

#include <cstdint>
#include <optional>
#include <vector>

#include "lcmtypes/messages.hpp"
#include "segmenter/evaluation/live/live_map.hpp"
#include "segmenter/evaluation/live/surface_sights.hpp"
#include "segmenter/evaluation/live/view_measures.hpp"

namespace kintsugi::segmenter {

struct LiveConfig {
  double skip_s = 2.0;     ///< at the beginning of the run, of which no view counts
  double radius_m = 0.03;  ///< between what the camera measures and a point of a segment
  double region_m = 0.05;  ///< side of a region of surface
  /// The lowest weight of surface in slices, in frames: what was seen less is in none.
  std::int64_t min_frames = 8;
  int grid = 5;  ///< queries by pixel for each view: so many along u and v
};

/// Answers to queries at many pixels.
struct QueryCounts {
  std::int64_t num_asked = 0;  ///< pixels at which the camera measures something
  std::int64_t num_answered = 0;
  std::int64_t num_wrong = 0;   ///< further than the radius from what is measured
  std::int64_t num_behind = 0;  ///< further than 10 cm behind it
};

struct LiveReport {
  std::int64_t session = 0;
  double duration_s = 0.0;      ///< from the first to the last view, wall clock
  std::int64_t num_views = 0;   ///< that count
  std::int64_t num_lost = 0;    ///< views whose pose is not known; not counted
  std::int64_t num_centre = 0;  ///< views that measure something at their centre
  std::int64_t num_centre_covered = 0;
  std::int64_t num_centre_right = 0;

  std::optional<double> covered_mean;         ///< share of what is measured, over the views
  std::optional<double> covered_worst_tenth;  ///< a tenth of the views has less

  std::int64_t num_regions = 0;  ///< of surface in the final map
  std::int64_t num_delays = 0;   ///< regions that were seen often enough
  std::optional<double> delay_median_s;
  std::optional<double> delay_p99_s;

  QueryCounts pixel;
  QueryCounts ray;

  std::int64_t num_segments = 0;  ///< in the final map
  std::int64_t num_changes = 0;   ///< of labels of regions, later than a second after the first
  std::int64_t num_changes_by_merge = 0;
  std::int64_t num_handovers = 0;
  std::int64_t num_unchanged = 0;  ///< regions

  std::int64_t revisions_sent = 0;
  std::int64_t points_sent = 0;
  std::int64_t num_points = 0;  ///< in the final map, with a segment
};

/// Follows one session of a mapper. Events come in the order of the wall clock.
class LiveEvaluation {
 public:
  explicit LiveEvaluation(const LiveConfig& config);

  /// @param now_s wall clock at which the message was complete, seconds
  void add(CloudSlice slice, double now_s) { map_.add(std::move(slice), now_s); }
  void add(const SegmentUpdate& update, double now_s) { map_.add(update, now_s); }
  void add(const CameraView& view, double now_s);

  /// To be called once, when all events have come.
  LiveReport report();

  std::int64_t num_views() const { return num_views_; }

 private:
  void look_at_centre(const CameraView& view);
  void ask_pixels(const CameraView& view);
  void report_centre(LiveReport& report) const;
  void report_delays(LiveReport& report) const;
  void report_regions(LiveReport& report) const;

  LiveConfig config_;
  LiveMap map_;
  SurfaceSights sights_;
  LiveReport counts_;
  std::int64_t num_views_ = 0;
  double first_s_ = 0.0;  // of the first view
  double last_s_ = 0.0;
  std::vector<SegmentPoint> centres_;  // what was answered at the centres
  std::vector<double> covered_;        // of each view
};

}  // namespace kintsugi::segmenter
