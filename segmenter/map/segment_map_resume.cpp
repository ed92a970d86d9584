// SegmentMap from and to its state.

#include <algorithm>
#include <functional>
#include <limits>
#include <map>
#include <set>
#include <span>
#include <stdexcept>

#include "lcmtypes/codec/codec.hpp"
#include "segmenter/core/make_engine.hpp"
#include "segmenter/map/segment_map.hpp"

namespace kintsugi::segmenter {
namespace {

std::string name_of(const SliceRecord& slice) { return "slice " + std::to_string(slice.slice_id); }

/// The points of a slice as received, with inadmissible ones in place of those that were rejected.
std::vector<CloudPoint> as_received(const SliceRecord& slice,
                                    std::span<const CloudPoint> accepted_P) {
  CloudPoint inadmissible;
  inadmissible.x = std::numeric_limits<float>::quiet_NaN();
  std::vector<CloudPoint> points_P(static_cast<std::size_t>(slice.num_points), inadmissible);
  for (PointIndex k = 0; k < slice.count; ++k) {
    points_P[static_cast<std::size_t>(slice.index_of(k))] = accepted_P[k];
  }
  return points_P;
}

SequenceSet set_of(const std::vector<SequenceRange>& chunks) {
  SequenceSet set;
  std::int64_t end = 0;
  for (const SequenceRange range : chunks) {
    if (range.first < end || range.last < range.first || range.last >= kMaxSequence) {
      throw std::invalid_argument("chunks " + std::to_string(range.first) + " to " +
                                  std::to_string(range.last) +
                                  " are not a range above the ranges before");
    }
    set.insert(range);
    end = range.last + 1;
  }
  return set;
}

/// Empties `records` and reserves memory for `size` of them; on reuse some more, because maps grow.
template <class Record>
void clear_for(std::vector<Record>& records, std::size_t size) {
  const bool is_new = records.capacity() == 0;
  records.clear();
  if (records.capacity() < size) {
    records.reserve(is_new ? size : size + size / 4);
  }
}

void check_counts(const SegmentMapState& state) {
  if (state.final_revision_sum < 0) {
    throw std::invalid_argument("final_revision_sum is " +
                                std::to_string(state.final_revision_sum) + ", expected >= 0");
  }
  std::uint64_t num_points = 0;
  for (const SliceRecord& slice : state.slices) {
    const bool is_ascending = std::adjacent_find(slice.rejected.begin(), slice.rejected.end(),
                                                 std::greater_equal<>()) == slice.rejected.end();
    const bool is_within = slice.rejected.empty() || (slice.rejected.front() >= 0 &&
                                                      slice.rejected.back() < slice.num_points);
    if (slice.num_points < 0 || !is_ascending || !is_within ||
        std::int64_t{slice.count} + std::ssize(slice.rejected) != slice.num_points) {
      throw std::invalid_argument(
          name_of(slice) + " has " + std::to_string(slice.num_points) +
          " points, which is not the sum of its accepted and rejected ones");
    }
    const bool is_moved = !slice.place.X_WP.is_identity() && slice.count > 0;
    if ((slice.points_P != nullptr) != is_moved ||
        (is_moved && slice.points_P->size() != slice.count)) {
      throw std::invalid_argument(name_of(slice) + " is moved, but not all its points, or none");
    }
    if (slice.first != num_points) {
      throw std::invalid_argument(name_of(slice) + " does not follow the slice before it");
    }
    num_points += slice.count;
  }
  if (num_points != state.points_W.size() || num_points != state.segment_ids.size()) {
    throw std::invalid_argument("slices of " + std::to_string(num_points) + " points, but " +
                                std::to_string(state.points_W.size()) + " points with " +
                                std::to_string(state.segment_ids.size()) + " segment ids");
  }
}

void check_last_changes(const SegmentMapState& state, const std::set<std::int32_t>& slice_ids) {
  for (const LastChange& change : state.last_changes) {
    if (!slice_ids.contains(change.slice_id)) {
      throw std::invalid_argument("a segment last changed with slice " +
                                  std::to_string(change.slice_id) + ", which is not in the map");
    }
  }
}

void restore_cloud(const SegmentMapState& state, PointCloud& cloud) {
  for (const SliceRecord& slice : state.slices) {
    const auto accepted_W = std::span(state.points_W).subspan(slice.first, slice.count);
    const auto accepted_P = slice.points_P ? std::span(*slice.points_P) : accepted_W;
    const SliceRecord& stored = cloud.add_slice(slice.slice_id, as_received(slice, accepted_P),
                                                slice.revision, slice.patch, slice.place);
    if (stored.rejected != slice.rejected) {
      throw std::invalid_argument(name_of(slice) + " has an accepted point that is inadmissible");
    }
  }
}

/// A partition as SegmentationEngine::resume() takes it: each component named by its smallest
/// point.
struct Partition {
  std::vector<ComponentId> components;
  std::vector<double> thetas;  ///< by name

  explicit Partition(const SegmentMapState& state)
      : components(state.segment_ids.size()), thetas(state.segment_ids.size()) {
    std::map<std::uint32_t, ComponentId> name_of_segment;
    for (PointIndex i = 0; i < components.size(); ++i) {
      components[i] = name_of_segment.try_emplace(state.segment_ids[i], i).first->second;
    }
    if (name_of_segment.size() != state.thetas.size()) {
      throw std::invalid_argument(std::to_string(name_of_segment.size()) + " segments, but " +
                                  std::to_string(state.thetas.size()) + " thetas");
    }
    auto theta = state.thetas.begin();
    for (const auto& [id, name] : name_of_segment) {
      const double max_theta = state.config.engine.max_weight();
      if (!(*theta > 0.0 && *theta <= max_theta)) {
        throw std::invalid_argument("segment " + std::to_string(id) + " has theta " +
                                    std::to_string(*theta) + ", must be above 0 and at most T + k");
      }
      thetas[name] = *theta++;
    }
  }
};

}  // namespace

SegmentMap::SegmentMap(const SegmentMapState& state)
    : config_((state.config.validate(), state.config)),
      session_(state.session),
      map_session_(state.map_session),
      map_name_(state.map_name),
      cloud_(config_.engine.resolution_m),
      engine_(make_engine(config_.mode, cloud_, config_.engine)),
      statistics_(static_cast<float>(config_.engine.resolution_m)),
      motions_(state.motions),
      final_slice_id_(state.final_slice_id),
      final_revision_sum_(state.final_revision_sum),
      chunks_(set_of(state.chunks)) {
  check_counts(state);
  restore_cloud(state, cloud_);
  for (const SliceRecord& slice : state.slices) {
    slice_ids_.insert(slice.slice_id);
    revision_sum_ += slice.revision;
  }
  if (has_final_slice() && !slice_ids_.contains(final_slice_id_)) {
    throw std::invalid_argument("the final slice " + std::to_string(final_slice_id_) +
                                " is not in the map");
  }
  check_last_changes(state, slice_ids_);
  const CloudChange everything = cloud_.take_change();
  if (config_.mode == "voting") {
    const Partition partition(state);
    engine_->resume(everything, partition.components, partition.thetas);
  } else {
    engine_->update(everything);
  }
  ids_ = SegmentIds(engine_->components(), state.segment_ids, state.next_id);
  std::vector<IdChange> changes;
  changes.reserve(everything.added.size());
  for (const PointIndex i : everything.added) changes.push_back({i, kNoSegment, ids_.ids()[i]});
  statistics_.apply(cloud_, ids_, changes);
  statistics_.set_last_changes(state.last_changes);
}

SegmentMapState SegmentMap::state() const {
  SegmentMapState state;
  copy_state(state);
  return state;
}

void SegmentMap::copy_state(SegmentMapState& state) const {
  state.config = config_;
  state.session = session_;
  state.map_session = map_session_;
  state.map_name = map_name_;
  state.final_slice_id = final_slice_id_;
  state.final_revision_sum = final_revision_sum_;
  state.next_id = ids_.next_id();
  state.motions = motions_;
  state.chunks = chunks_.ranges();
  state.last_changes = statistics_.last_changes();
  state.slices.clear();
  clear_for(state.points_W, cloud_.num_live());
  clear_for(state.segment_ids, cloud_.num_live());
  state.thetas.clear();
  for (SliceRecord slice : cloud_.slices()) {
    const auto points_W = cloud_.points_W().subspan(slice.first, slice.count);
    const PointIndex first = slice.first;
    slice.first = static_cast<PointIndex>(state.points_W.size());
    state.points_W.insert(state.points_W.end(), points_W.begin(), points_W.end());
    for (PointIndex i = first; i < first + slice.count; ++i) {
      state.segment_ids.push_back(i < ids_.ids().size() ? ids_.ids()[i] : kNoSegment);
    }
    state.slices.push_back(std::move(slice));
  }
  if (config_.mode == "voting") {
    for (std::uint32_t id = 1; id < ids_.next_id(); ++id) {
      if (ids_.num_points_of(id) > 0) state.thetas.push_back(theta(id));
    }
  }
}

}  // namespace kintsugi::segmenter
