#include "segmenter/objects/changes/map_changes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <set>
#include <span>
#include <utility>

#include "lcmtypes/base/logger.hpp"
#include "lcmtypes/scene/up_direction.hpp"
#include "segmenter/core/points/transformed_points.hpp"
#include "segmenter/objects/changes/change_groups.hpp"
#include "segmenter/objects/changes/changed_points.hpp"
#include "segmenter/objects/changes/displaced_points.hpp"
#include "segmenter/objects/changes/filled_space.hpp"
#include "segmenter/objects/changes/map_errors.hpp"
#include "segmenter/objects/changes/map_side.hpp"
#include "segmenter/objects/changes/moved_things.hpp"
#include "segmenter/objects/maps/surface_samples.hpp"
#include "segmenter/preprocess/nearest_neighbours.hpp"
#include "segmenter/views/observed_space.hpp"

namespace kintsugi::segmenter {
namespace {

// Where AFTER and BEFORE both have surface, this many points tell how the light has changed.
constexpr std::size_t kMostForLight = 20'000;

/// Gain of each channel from BEFORE's light to AFTER's: the ratio of medians over common surface.
std::array<double, 3> gains_of(std::span<const CloudPoint> before_A,
                               std::span<const CloudPoint> after, double voxel_m) {
  std::vector<CloudPoint> some;
  const std::size_t step = std::max<std::size_t>(1, before_A.size() / kMostForLight);
  for (std::size_t i = 0; i < before_A.size(); i += step) some.push_back(before_A[i]);
  const NearestNeighbours tree(after);
  NearestNeighbours::Result nearest;
  tree.find(some, 1, nearest);
  constexpr std::array kChannels = {&CloudPoint::red, &CloudPoint::green, &CloudPoint::blue};
  std::array<double, 3> gains = {1.0, 1.0, 1.0};
  for (std::size_t channel = 0; channel < 3; ++channel) {
    std::vector<double> ratios;
    for (std::size_t i = 0; i < some.size(); ++i) {
      const CloudPoint& there = after[nearest.indices[i]];
      if (std::sqrt(nearest.squared_distances[i]) > static_cast<float>(voxel_m)) continue;
      const double was = some[i].*kChannels[channel];
      const double is = there.*kChannels[channel];
      if (was >= 20.0 && is >= 20.0) ratios.push_back(is / was);
    }
    if (ratios.size() < 100) continue;
    const auto middle = ratios.begin() + std::ssize(ratios) / 2;
    std::ranges::nth_element(ratios, middle);
    gains[channel] = *middle;
  }
  return gains;
}

void relight(std::vector<CloudPoint>& points, const std::array<double, 3>& gains) {
  const auto level = [](std::uint8_t value, double gain) {
    return static_cast<std::uint8_t>(std::lround(std::min(255.0, value * gain)));
  };
  for (CloudPoint& point : points) {
    point.red = level(point.red, gains[0]);
    point.green = level(point.green, gains[1]);
    point.blue = level(point.blue, gains[2]);
  }
}

/// @param error_m of the map
ObservedSpace space_of(const ObservedMap& map, const Pose& X_AW, double error_m) {
  ObservedSpace space(error_m);
  for (MapView view : map.views) {
    view.X_WC = X_AW * view.X_WC;
    space.add(std::move(view));
  }
  return space;
}

std::vector<CloudPoint> chosen(std::span<const CloudPoint> points,
                               const std::vector<std::size_t>& indices) {
  std::vector<CloudPoint> some;
  some.reserve(indices.size());
  for (const std::size_t i : indices) some.push_back(points[i]);
  return some;
}

std::int64_t num_unknown(const std::vector<PointChange>& changes) {
  return std::ranges::count(changes, PointChange::kUnknown);
}

/// A map with what is changed in it.
struct Side {
  MapSide map;
  std::vector<PointChange> changes;
  std::vector<ChangeGroup> groups;

  void group() { groups = group_changes(map.points(), map.segment_ids(), changes, map.voxel_m()); }
};

/// Both maps, decided by what their cameras saw, and then by what takes the places of what.
void find_changed(Side& before, Side& after, const Eigen::Vector3d& up, const MapErrors& errors) {
  before.changes = changes_of(before.map, after.map, errors);
  after.changes = changes_of(after.map, before.map, errors);
  before.group();
  after.group();
  mark_displaced(before.map, before.changes, after.map, after.groups, up, errors);
  mark_displaced(after.map, after.changes, before.map, before.groups, up, errors);
  before.group();
  after.group();
}

/// Whether the group is a piece of something that moved, and not a thing of its own.
bool has_moved(const ChangeGroup& group, const MapSide& map, const std::vector<FilledSpace>& rooms,
               const std::vector<Pose>& motions, const MapSide& other) {
  for (std::size_t i = 0; i < rooms.size(); ++i) {
    if (is_part_of(group.points, map, rooms[i], motions[i], other)) return true;
  }
  return false;
}

std::vector<std::uint32_t> ids_of(const std::set<std::uint32_t>& segments) {
  return {segments.begin(), segments.end()};
}

MapChange change_of(const MovedThing& moved, std::span<const CloudPoint> before,
                    std::span<const CloudPoint> after) {
  MapChange change;
  change.kind = ChangeKind::kMoved;
  change.before = chosen(before, moved.before.points);
  change.after = chosen(after, moved.after.points);
  change.before_segments = ids_of(moved.before.segments);
  change.after_segments = ids_of(moved.after.segments);
  change.X_after_before = moved.X_after_before;
  change.score = moved.score;
  return change;
}

}  // namespace

MapChanges find_changes(const ObservedMap& before, const ObservedMap& after, const Pose& X_AB) {
  const double voxel_m = std::max(before.resolution_m, after.resolution_m);
  const std::vector<CloudPoint> before_A = transformed(X_AB, before.points_W);
  std::vector<CloudPoint> relit_A = before_A;
  relight(relit_A, gains_of(before_A, after.points_W, voxel_m));
  Side was{.map = {std::move(relit_A), before.segment_ids, voxel_m}, .changes = {}, .groups = {}};
  Side is{.map = {after.points_W, after.segment_ids, voxel_m}, .changes = {}, .groups = {}};
  const MapErrors errors = errors_of(was.map, is.map);
  spdlog::debug("what differs by less than {:.1f} cm and {:.0f} in CIELAB is the same",
                100.0 * errors.distance_m, errors.color);
  // Of the maps' errors each has a half, and so have its views.
  was.map.set_space(space_of(before, X_AB, errors.distance_m / 2.0));
  is.map.set_space(space_of(after, Pose::Identity(), errors.distance_m / 2.0));
  UpDirection up;
  up.add(after.points_W);
  find_changed(was, is, up.up_W(), errors);
  const std::vector<MovedThing> moved = find_moved(
      {was.map, was.changes, was.groups}, {is.map, is.changes, is.groups}, up.up_W(), errors);
  MapChanges result;
  result.not_seen_again = num_unknown(was.changes);
  result.not_seen_before = num_unknown(is.changes);
  std::vector<FilledSpace> rooms_before;
  std::vector<FilledSpace> rooms_after;
  std::vector<Pose> motions;
  std::vector<Pose> motions_back;
  for (const MovedThing& thing : moved) {
    result.changes.push_back(change_of(thing, before_A, after.points_W));
    const std::vector<CloudPoint> all = whole_surface(thing, was.map, is.map);
    motions.push_back(thing.X_after_before);
    motions_back.push_back(thing.X_after_before.inverse(Eigen::Isometry));
    rooms_after.emplace_back(all, up.up_W());
    rooms_before.emplace_back(transformed(motions_back.back(), all), up.up_W());
  }
  for (const ChangeGroup& group : was.groups) {
    if (!group.is_thing || has_moved(group, was.map, rooms_before, motions, is.map)) continue;
    MapChange& change = result.changes.emplace_back();
    change.kind = ChangeKind::kGone;
    change.before = chosen(before_A, group.points);
    change.before_segments = group.segment_ids;
    change.score = group.share_changed;
  }
  for (const ChangeGroup& group : is.groups) {
    if (!group.is_thing || has_moved(group, is.map, rooms_after, motions_back, was.map)) continue;
    MapChange& change = result.changes.emplace_back();
    change.kind = ChangeKind::kNew;
    change.after = chosen(after.points_W, group.points);
    change.after_segments = group.segment_ids;
    change.score = group.share_changed;
  }
  std::ranges::stable_sort(result.changes, std::ranges::greater{},
                           [](const MapChange& change) { return change.points().size(); });
  std::int32_t id = 0;
  for (MapChange& change : result.changes) change.id = ++id;
  return result;
}

}  // namespace kintsugi::segmenter
