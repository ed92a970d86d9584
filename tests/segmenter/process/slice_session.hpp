#pragma once
// A mapper session for tests, and what a listener makes of the updates.

#include <algorithm>
#include <cstdint>
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
