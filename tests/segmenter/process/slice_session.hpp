#pragma once
// A mapper session for tests, and what a listener makes of the updates.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <set>
#include <vector>

#include "lcmtypes/messages.hpp"
#include "segmenter/core/ids/slice_labels.hpp"
#include "segmenter/map/segment_map.hpp"
#include "tests/segmenter/core/random_clouds.hpp"

namespace kintsugi::segmenter::testing {

/// `num_slices` strips of one wavy sheet: every slice touches the one before.
inline std::vector<CloudSlice> wavy_session(int num_slices, int points_per_slice,
                                            std::int64_t session = 5, unsigned seed = 1) {
  auto points = random_cloud(CloudShape::kWaves, num_slices * points_per_slice, seed);
  std::sort(points.begin(), points.end(),
            [](const CloudPoint& a, const CloudPoint& b) { return a.x < b.x; });
  std::vector<CloudSlice> slices;
  for (int i = 0; i < num_slices; ++i) {
    CloudSlice& slice = slices.emplace_back();
    slice.utime = 1000 + i;
    slice.session = session;
    slice.map_name = "map";
    slice.id = i;
    slice.kind = i + 1 == num_slices ? SliceKind::kFinal : SliceKind::kShiftPlusX;
    slice.resolution_m = 0.01F;
    const auto begin = points.begin() + std::ptrdiff_t{i} * points_per_slice;
    slice.points_W.assign(begin, begin + points_per_slice);
  }
  return slices;
}

/// Four patches and the final slice. Two patches are one sheet in part 0, the others one in part 1,
/// a kilometre away along x of W. Both sheets are the same in the frame P of their patches; the
/// first point of each patch is not accepted.
inline std::vector<CloudSlice> session_in_two_parts(int points_per_patch = 50) {
  const std::vector<CloudSlice> sheet = wavy_session(2, points_per_patch);
  std::vector<CloudSlice> slices{sheet[0], sheet[1], sheet[0], sheet[1]};
  for (std::size_t i = 0; i < slices.size(); ++i) {
    slices[i].utime = 1000 + static_cast<std::int64_t>(i);
    slices[i].id = static_cast<std::int32_t>(i);
    slices[i].kind = SliceKind::kPatch;
    slices[i].ends_batch = true;
    slices[i].points_W[0].x = std::numeric_limits<float>::quiet_NaN();
    slices[i].part = static_cast<std::int32_t>(i / 2);
    slices[i].X_WP.t_WP[0] = 1000.0F * static_cast<float>(slices[i].part);
  }
  CloudSlice last = slices.back();
  last.id = 4;
  last.kind = SliceKind::kFinal;
  last.points_W.clear();
  last.X_WP = {};
  slices.push_back(last);
  return slices;
}

/// A loop joins part 1 of session_in_two_parts() to part 0: its patches lie 5 m beside it.
inline CloudSlice correction_that_joins() {
  CloudSlice correction = session_in_two_parts().back();
  correction.id = 5;
  correction.kind = SliceKind::kCorrection;
  correction.correction = 1;
  correction.part = 0;
  PatchPose X_WP;
  X_WP.t_WP[0] = 5.0F;
  correction.motions = {{2, X_WP}, {3, X_WP}};
  return correction;
}

/// Labels of all points, by slice.
using Labels = std::map<std::int32_t, std::vector<std::uint32_t>>;

inline Labels labels_of(const SegmentMap& map) {
  Labels labels;
  for (const SliceRecord& slice : map.cloud().slices()) {
    labels[slice.slice_id] = slice_labels(slice, map.segment_ids().ids());
  }
  return labels;
}

/// True when the two are one labelling up to the names of the labels.
inline bool same_partition(const Labels& a, const Labels& b) {
  std::map<std::uint32_t, std::uint32_t> forth;
  std::map<std::uint32_t, std::uint32_t> back;
  for (const auto& [slice, labels] : a) {
    const auto& others = b.at(slice);
    if (labels.size() != others.size()) return false;
    for (std::size_t i = 0; i < labels.size(); ++i) {
      if (forth.try_emplace(labels[i], others[i]).first->second != others[i]) return false;
      if (back.try_emplace(others[i], labels[i]).first->second != labels[i]) return false;
    }
  }
  return a.size() == b.size();
}

/// What a listener knows who has applied the updates in order.
class LabelMirror {
 public:
  void apply(const SegmentUpdate& update) {
    labels_[update.slice_id] = update.labels;
    for (const LabelRun& run : update.runs) {
      auto& labels = labels_.at(run.slice_id);
      for (std::int32_t i = run.first; i < run.first + run.count; ++i) {
        labels.at(static_cast<std::size_t>(i)) = run.segment_id;
      }
    }
    for (const SegmentStatistics& statistics : update.statistics) {
      statistics_[statistics.segment_id] = statistics;
      last_changes_[statistics.segment_id] = {update.utime, update.slice_id};
    }
    for (const SegmentEvent& event : update.events) {
      if (event.type == SegmentEventType::kMerged) statistics_.erase(event.other_id);
      if (event.type == SegmentEventType::kRetired) statistics_.erase(event.segment_id);
    }
  }

  const Labels& labels() const { return labels_; }

  std::int64_t num_segments() const {
    std::set<std::uint32_t> ids;
    for (const auto& [slice, labels] : labels_) {
      ids.insert(labels.begin(), labels.end());
    }
    ids.erase(kNoSegment);
    return static_cast<std::int64_t>(ids.size());
  }

  /// Of the segments that statistics() has.
  std::vector<LastChange> last_changes() const {
    std::vector<LastChange> all;
    for (const auto& [id, statistics] : statistics_) all.push_back(last_changes_.at(id));
    return all;
  }

  std::vector<SegmentStatistics> statistics() const {
    std::vector<SegmentStatistics> all;
    all.reserve(statistics_.size());
    for (const auto& [id, statistics] : statistics_) {
      all.push_back(statistics);
    }
    return all;
  }

 private:
  Labels labels_;
  std::map<std::uint32_t, SegmentStatistics> statistics_;
  std::map<std::uint32_t, LastChange> last_changes_;
};

}  // namespace kintsugi::segmenter::testing
