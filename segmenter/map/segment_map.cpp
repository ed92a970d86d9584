#include "segmenter/map/segment_map.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace kintsugi::segmenter {
namespace {

SegmentMapConfig at_resolution(SegmentMapConfig config, float resolution_m) {
  config.engine.resolution_m = resolution_m;
  config.validate();
  return config;
}

}  // namespace

void SegmentMapConfig::validate() const {
  const auto modes = engine_modes();
  if (std::find(modes.begin(), modes.end(), mode) == modes.end()) {
    std::string known;
    for (const std::string_view name : modes) {
      known += (known.empty() ? "" : ", ") + std::string(name);
    }
    throw std::invalid_argument("mode is '" + mode + "', must be one of: " + known);
  }
  engine.validate();
}

SegmentMap::SegmentMap(const SegmentMapConfig& config, std::int64_t session,
                       const CloudSlice& first)
    : config_(at_resolution(config, first.resolution_m)),
      session_(session),
      map_session_(first.session),
      map_name_(first.map_name),
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

  const PointIndex first_new = cloud_.size();
  for (const CloudSlice& slice : slices) {
    cloud_.add_slice(slice.id, slice.points_W);
    slice_ids_.insert(slice.id);
    if (slice.kind == SliceKind::kFinal) {
      final_slice_id_ = slice.id;
    }
  }
  engine_->update(cloud_.take_change());
  IdUpdate change = ids_.update(engine_->components(), engine_->changed());
  const auto changed_segments = statistics_.apply(cloud_, ids_, change.changes);

  std::vector<SegmentUpdate> updates;
  const auto records = cloud_.slices().last(slices.size());
  const auto num_before = static_cast<std::int32_t>(cloud_.slices().size() - slices.size());
  for (std::size_t i = 0; i < slices.size(); ++i) {
    updates.push_back(
        make_update(slices[i], records[i], num_before + static_cast<std::int32_t>(i) + 1));
  }
  SegmentUpdate& last = updates.back();
  last.is_final = is_complete();
  last.runs = label_runs(cloud_, change.changes, first_new);
  last.events = std::move(change.events);
  for (const std::uint32_t id : changed_segments) {
    last.statistics.push_back(statistics_(id));
  }
  return updates;
}

bool SegmentMap::is_complete() const {
  return has_final_slice() &&
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
  if (slice_ids_.contains(slice.id)) {
    throw std::invalid_argument(name + " is in the map already");
  }
}

SegmentUpdate SegmentMap::make_update(const CloudSlice& slice, const SliceRecord& record,
                                      std::int32_t num_slices) const {
  SegmentUpdate update;
  update.utime = slice.utime;
  update.session = session_;
  update.map_session = map_session_;
  update.map_name = map_name_;
  update.slice_id = slice.id;
  update.slice_revision = slice.revision;
  update.num_slices = num_slices;
  update.num_points = std::int64_t{record.first} + record.count;
  update.num_segments = ids_.num_segments();
  update.labels = slice_labels(record, ids_.ids());
  return update;
}

}  // namespace kintsugi::segmenter
