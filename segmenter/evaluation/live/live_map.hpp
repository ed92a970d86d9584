#pragma once
// The segment map as a receiver of slices and updates has it at one moment.

#include <cstdint>
#include <map>
#include <unordered_map>
#include <utility>
#include <vector>

#include "lcmtypes/messages.hpp"
#include "lcmtypes/patch_motions.hpp"
#include "segmenter/evaluation/live/first_labels.hpp"
#include "segmenter/evaluation/live/point_grid.hpp"
#include "segmenter/evaluation/live/region_labels.hpp"

namespace kintsugi::segmenter {

/// Points that were found near a place, as LabelledCloud has them.
struct FoundPoints {
  std::vector<CloudPoint> points_W;
  std::vector<std::uint32_t> segment_ids;
};

/// A revision of a slice is shown from the moment on when both its points and its labels have come;
/// until then the revision before it is.
class LiveMap {
 public:
  /// @param radius_m within which points are looked for, metres, > 0
  /// @param region_m side of a region of RegionLabels, metres, > 0
  LiveMap(double radius_m, double region_m)
      : grid_(radius_m), regions_(region_m), first_labels_(radius_m) {}

  /// @param now_s wall clock, as below
  void add(CloudSlice slice, double now_s);
  void add(const SegmentUpdate& update, double now_s);
  /// The labels of regions are those of this moment.
  void settle(double now_s) { regions_.settle(now_s, heirs_); }

  const PointGrid& grid() const { return grid_; }
  const RegionLabels& regions() const { return regions_; }
  const FirstLabels& first_labels() const { return first_labels_; }
  const Heirs& heirs() const { return heirs_; }
  /// Calls visit(p_W) for each point of a segment.
  template <class Visit>
  void for_each_point(const Visit& visit) const {
    for (const auto& [id, shown] : shown_) {
      for (std::size_t i = 0; i < shown.points_W.size(); ++i) {
        const CloudPoint& p = shown.points_W[i];
        if (shown.labels[i] != kNoSegment) visit(Eigen::Vector3d(p.x, p.y, p.z));
      }
    }
  }
  /// Appends a point of the grid.
  void take(const PlacedPoint& point, FoundPoints& found) const;
  std::uint32_t segment_of(const PlacedPoint& point) const;

  std::int64_t num_points() const { return num_points_; }    ///< shown, with a segment
  std::int64_t points_sent() const { return points_sent_; }  ///< of all revisions that came
  std::int64_t revisions_sent() const { return revisions_sent_; }
  float resolution_m() const { return resolution_m_; }  ///< 0: no slice came

 private:
  struct Shown {
    std::int32_t revision = -1;
    CloudSlice slice;                  ///< as received
    std::vector<CloudPoint> points_W;  ///< where corrections have put them
    std::vector<std::uint32_t> labels;
  };
  using RevisionOfSlice = std::pair<std::int32_t, std::int32_t>;  // slice, revision
  using Labels = std::vector<std::uint32_t>;

  void relabel(const LabelRun& run, double now_s);
  void show_if_complete(const RevisionOfSlice& which, double now_s);
  void show(CloudSlice slice, Labels labels, double now_s);

  PointGrid grid_;
  RegionLabels regions_;
  FirstLabels first_labels_;
  Heirs heirs_;
  std::unordered_map<std::int32_t, Shown> shown_;  // by slice id
  std::map<RevisionOfSlice, CloudSlice> slices_;   // without labels yet
  std::map<RevisionOfSlice, Labels> labels_;       // without points yet
  PatchMotions motions_;
  std::int64_t num_points_ = 0;
  std::int64_t points_sent_ = 0;
  std::int64_t revisions_sent_ = 0;
  float resolution_m_ = 0.0F;
};

}  // namespace kintsugi::segmenter
