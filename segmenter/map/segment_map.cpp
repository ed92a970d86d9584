#include "segmenter/map/segment_map.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "segmenter/core/ids/slice_labels.hpp"
#include "segmenter/core/make_engine.hpp"

namespace kintsugi::segmenter {
namespace {

SegmentMapConfig at_resolution(SegmentMapConfig config, float resolution_m) {
  config.engine.resolution_m = resolution_m;
  config.validate();
  return config;
}

}  // namespace

SegmentMap::SegmentMap(const SegmentMapConfig& config, std::int64_t session,
                       const CloudSlice& first)
    : config_(at_resolution(config, first.resolution_m)),
      session_(session),
      map_session_(first.session),
      map_name_(first.map_name),
      cloud_(config_.engine.resolution_m),
      engine_(make_engine(config_.mode, cloud_, config_.engine)),
      statistics_(first.resolution_m) {}

std::vector<SegmentUpdate> SegmentMap::add(std::span<const CloudSlice> slices) {
  std::set<std::int32_t> new_ids;
  for (const CloudSlice& slice : slices) {
    check(slice);
    if (!new_ids.insert(slice.id).second) {
      throw std::invalid_argument("slice " + std::to_string(slice.id) + " comes twice");
    }
  }
  if (slices.empty()) {
    return {};
  }

  ++version_;
  std::vector<SegmentUpdate> updates;
  for (const CloudSlice& slice : slices) {
    store(slice);
    updates.push_back(begin_update(slice));
  }
  const CloudChange change = cloud_.take_change();
  engine_->update(change);
  IdUpdate id_update = ids_.update(cloud_, change, engine_->components(), engine_->changed());
  for (SegmentUpdate& update : updates) {
    update.num_segments = ids_.num_segments();
    update.labels = slice_labels(*cloud_.find_slice(update.slice_id), ids_.ids());
  }
  SegmentUpdate& last = updates.back();
  last.is_final = is_complete();
  last.runs = label_runs(cloud_, id_update.changes, change.moved, ids_.ids());
  const LastChange now{last.utime, last.slice_id};
  const std::vector<std::uint32_t> changed_ids =
      change.moved_in_place.empty()
          ? statistics_.apply(cloud_, ids_, id_update.changes, now)
          : statistics_.recount(cloud_, ids_, id_update.changes, change.moved_in_place, now);
  for (const std::uint32_t id : changed_ids) {
    last.statistics.push_back(statistics_(id));
  }
  last.events = std::move(id_update.events);
  return updates;
}

void SegmentMap::store(const CloudSlice& slice) {
  if (slice.kind == SliceKind::kCorrection) move_patches(slice);
  const PatchState patch = patch_state_of(slice);
  const PatchPlace place = motions_.place_of(slice);
  revision_sum_ += slice.revision;
  if (const SliceRecord* const before = cloud_.find_slice(slice.id); before == nullptr) {
    cloud_.add_slice(slice.id, slice.points_W, slice.revision, patch, place);
    slice_ids_.insert(slice.id);
  } else {
    revision_sum_ -= before->revision;
    cloud_.replace_slice(slice.id, slice.points_W, slice.revision, patch, place);
  }
  if (slice.kind == SliceKind::kFinal) {
    final_slice_id_ = slice.id;
    final_revision_sum_ = slice.revision_sum;
  }
  if (slice.num_chunks > 0) {
    chunks_.insert({slice.sequence, slice.sequence + slice.num_chunks - 1});
  }
}

/// Moves the patches that are in the map, unless they are where a newer correction has put them.
void SegmentMap::move_patches(const CloudSlice& correction) {
  std::vector<PlacedPatch> moving;
  std::int64_t num_points = 0;
  for (const PlacedPatch& placed : motions_.learn(correction)) {
    const SliceRecord* const record = cloud_.find_slice(placed.id);
    if (record == nullptr || record->patch == PatchState::kNoPatch) continue;
    if (record->place.correction >= correction.correction) continue;
    moving.push_back(placed);
    num_points += record->count;
  }
  // A point that gets another index comes and goes. Where the engine will start anew because of so
  // many, they may as well keep their indices, and all that is known by index.
  const bool starts_anew = 2.0 * static_cast<double>(num_points) >
                           config_.engine.rebuild_share * static_cast<double>(cloud_.num_live());
  if (starts_anew && engine_->takes_moves_in_place()) {
    cloud_.move_in_place(moving);
  } else {
    for (const auto& [id, place] : moving) cloud_.move_slice(id, place);
  }
}

std::vector<SegmentUpdate> SegmentMap::describe() const {
  std::vector<SegmentUpdate> updates;
  std::int64_t num_points = 0;
  for (const SliceRecord& slice : cloud_.slices()) {
    SegmentUpdate& update = updates.emplace_back();
    update.session = session_;
    update.map_session = map_session_;
    update.map_name = map_name_;
    update.slice_id = slice.slice_id;
    update.slice_revision = slice.revision;
    update.num_slices = static_cast<std::int32_t>(updates.size());
    update.num_points = num_points += slice.count;
    update.num_segments = ids_.num_segments();
    update.labels = slice_labels(slice, ids_.ids());
  }
  if (!updates.empty()) {
    updates.back().is_final = is_complete();
    updates.back().statistics = statistics_.all();
  }
  return updates;
}

bool SegmentMap::is_complete() const {
  return has_final_slice() && revision_sum_ >= final_revision_sum_ &&
         std::distance(slice_ids_.begin(), slice_ids_.upper_bound(final_slice_id_)) ==
             std::int64_t{final_slice_id_} + 1;
}

void SegmentMap::check(const CloudSlice& slice) const {
  const std::string name = "slice " + std::to_string(slice.id);
  if (slice.session != map_session_) {
    throw std::invalid_argument(name + " is of session " + std::to_string(slice.session) +
                                ", the map of session " + std::to_string(map_session_));
  }
  if (static_cast<double>(slice.resolution_m) != config_.engine.resolution_m) {
    throw std::invalid_argument(name + " has resolution_m " + std::to_string(slice.resolution_m) +
                                ", the map " + std::to_string(config_.engine.resolution_m));
  }
  if (slice.id < 0) {
    throw std::invalid_argument(name + " has a negative id");
  }
  const SliceRecord* const record = cloud_.find_slice(slice.id);
  if (record != nullptr && slice.revision <= record->revision) {
    throw std::invalid_argument(name + " of revision " + std::to_string(slice.revision) +
                                " is already in the map, in revision " +
                                std::to_string(record->revision));
  }
}

// The fields that are known before the engine has run.
SegmentUpdate SegmentMap::begin_update(const CloudSlice& slice) const {
  SegmentUpdate update;
  update.utime = slice.utime;
  update.session = session_;
  update.map_session = map_session_;
  update.map_name = map_name_;
  update.slice_id = slice.id;
  update.slice_revision = slice.revision;
  update.num_slices = static_cast<std::int32_t>(cloud_.slices().size());
  update.num_points = cloud_.num_live();
  return update;
}

}  // namespace kintsugi::segmenter
