#include "segmenter/objects/changes/whole_thing.hpp"

#include <algorithm>
#include <iterator>
#include <map>
#include <utility>

#include "segmenter/objects/changes/motion_evidence.hpp"
#include "segmenter/objects/maps/surface_samples.hpp"
#include "segmenter/objects/model/shortest_rotation.hpp"

namespace kintsugi::segmenter {
namespace {

// Of two grids and of edges that segments leave out.
constexpr double kTouch_vox = 3.0;
// A thing that is turned about its middle has changed at its ends only.
constexpr double kMostSizeRatio = 4.0;
constexpr double kLeastOfSegment = 0.1;
constexpr double kLeastOfGroup = 0.2;
// Of what moves nine of ten points agree: the others are edges and shades. Many may be hidden.
constexpr double kMostContradicted = 0.2;
constexpr double kLeastFound = 0.15;
constexpr double kBetter = 0.03;
constexpr std::size_t kLeastToDrop = 20;  // of fewer points the shares say nothing
constexpr double kInRoom = 0.8;
constexpr double kAside_vox = 6.0;  // what is pushed farther has left its room

double diagonal_m(const MapSide& map, std::span<const std::size_t> points) {
  Eigen::AlignedBox3f box;
  for (const std::size_t i : points) box.extend(position_of(map.points()[i]));
  return static_cast<double>(box.diagonal().norm());
}

void add_segment(Thing& thing, std::uint32_t id, const MapSide& map) {
  const std::vector<std::size_t>& more = map.points_of(id);
  const std::vector<std::size_t> old = std::move(thing.points);
  thing.points.clear();
  std::ranges::set_union(old, more, std::back_inserter(thing.points));
  thing.segments.insert(id);
}

Eigen::AlignedBox3f box_of(std::span<const CloudPoint> points) {
  Eigen::AlignedBox3f box;
  for (const CloudPoint& p : points) box.extend(position_of(p));
  return box;
}

std::set<std::uint32_t> touching(const Thing& thing, const MapSide& map) {
  const std::vector<CloudPoint> own = map.points_at(thing.points);
  const auto reach_m = static_cast<float>(kTouch_vox * map.voxel_m());
  const Eigen::AlignedBox3f box = box_of(own);
  std::vector<std::size_t> around =
      map.points_in({box.min().array() - reach_m, box.max().array() + reach_m});
  std::erase_if(around, [&](std::size_t i) {
    const std::uint32_t id = map.segment_ids()[i];
    return id == 0 || thing.segments.contains(id);
  });
  NearestNeighbours::Result nearest;
  NearestNeighbours(own).find(map.points_at(around), 1, nearest);
  std::set<std::uint32_t> ids;
  for (std::size_t k = 0; k < around.size(); ++k) {
    if (nearest.squared_distances[k] <= reach_m * reach_m) {
      ids.insert(map.segment_ids()[around[k]]);
    }
  }
  return ids;
}

/// The segments of which a share of kInRoom is in the room, widened by a margin.
std::set<std::uint32_t> segments_in(const FilledSpace& room, double margin_vox,
                                    const Eigen::AlignedBox3f& box, const MapSide& map) {
  const auto margin_m = static_cast<float>(margin_vox * map.voxel_m());
  std::map<std::uint32_t, double> counts;
  for (const std::size_t i :
       map.points_in({box.min().array() - margin_m, box.max().array() + margin_m})) {
    if (room.contains(position_of(map.points()[i]), -margin_m)) {
      counts[map.segment_ids()[i]] += 1.0;
    }
  }
  counts.erase(0);
  std::set<std::uint32_t> ids;
  for (const auto& [id, count] : counts) {
    if (count >= kInRoom * static_cast<double>(map.points_of(id).size())) ids.insert(id);
  }
  return ids;
}

/// Whether what is to be seen of the points is there after the motion, and better than without it.
/// Where nothing is to be seen, the room that they are in decides.
bool moves_with(std::span<const std::size_t> points, const MapSide& map, const Pose& X,
                const MapSide& other, bool is_inside) {
  const Evidence there = evidence_of(map, points, X, other);
  if (there.contradicted > kMostContradicted * there.known()) return false;
  const Evidence here = evidence_of(map, points, Pose::Identity(), other);
  if (there.found >= kLeastFound) return there.agreement() >= here.agreement() + kBetter;
  return is_inside && here.found < kLeastFound;
}

}  // namespace

Thing thing_of(const ChangeGroup& group, const MapSide& map) {
  Thing thing{.points = group.points, .segments = {}};
  std::map<std::uint32_t, double> counts;
  for (const std::size_t i : group.points) counts[map.segment_ids()[i]] += 1.0;
  const double size_m = diagonal_m(map, group.points);
  for (const auto& [id, count] : counts) {
    const std::vector<std::size_t>& segment = map.points_of(id);
    const bool has_much = count >= kLeastOfSegment * static_cast<double>(segment.size()) ||
                          count >= kLeastOfGroup * static_cast<double>(group.points.size());
    if (id == 0 || !has_much || diagonal_m(map, segment) > kMostSizeRatio * size_m) continue;
    add_segment(thing, id, map);
  }
  return thing;
}

Thing what_is_there(std::span<const CloudPoint> thing, const MapSide& map,
                    const Eigen::Vector3d& up) {
  Thing there;
  const FilledSpace room(thing, up);
  for (const std::uint32_t id : segments_in(room, kAside_vox, box_of(thing), map)) {
    add_segment(there, id, map);
  }
  return there;
}

bool add_what_follows(Thing& thing, const MapSide& map, const Pose& X, const MapSide& other,
                      std::span<const CloudPoint> all, const Eigen::Vector3d& up) {
  const double size_m = diagonal_m(map, thing.points);
  const std::set<std::uint32_t> inside =
      segments_in(FilledSpace(all, up), kTouch_vox, box_of(all), map);
  std::set<std::uint32_t> ids = touching(thing, map);
  ids.insert(inside.begin(), inside.end());
  bool has_more = false;
  for (const std::uint32_t id : ids) {
    const std::vector<std::size_t>& segment = map.points_of(id);
    if (thing.segments.contains(id) || diagonal_m(map, segment) > kMostSizeRatio * size_m) continue;
    if (!moves_with(segment, map, X, other, inside.contains(id))) continue;
    add_segment(thing, id, map);
    has_more = true;
  }
  return has_more;
}

bool is_part_of(std::span<const std::size_t> points, const MapSide& map, const FilledSpace& room,
                const Pose& X, const MapSide& other) {
  const auto margin_m = static_cast<float>(-kTouch_vox * map.voxel_m());
  const auto num_inside = std::ranges::count_if(
      points, [&](std::size_t i) { return room.contains(position_of(map.points()[i]), margin_m); });
  return static_cast<double>(num_inside) >= kInRoom * static_cast<double>(points.size()) &&
         evidence_of(map, points, X, other).contradicted <= kMostContradicted;
}

void drop_what_stays(Thing& thing, const MapSide& map, const Pose& X, const MapSide& other) {
  const auto stays = [&](std::uint32_t id) {
    const std::vector<std::size_t>& segment = map.points_of(id);
    if (segment.size() < kLeastToDrop) return false;
    const Evidence here = evidence_of(map, segment, Pose::Identity(), other);
    const Evidence there = evidence_of(map, segment, X, other);
    return here.found >= kLeastFound && here.agreement() >= there.agreement() + kBetter;
  };
  std::set<std::uint32_t> dropped;
  for (const std::uint32_t id : thing.segments) {
    if (stays(id)) dropped.insert(id);
  }
  if (dropped.empty()) return;
  std::vector<std::size_t> rest;
  std::ranges::copy_if(thing.points, std::back_inserter(rest),
                       [&](std::size_t i) { return !dropped.contains(map.segment_ids()[i]); });
  if (rest.empty()) return;
  thing.points = std::move(rest);
  for (const std::uint32_t id : dropped) thing.segments.erase(id);
}

Eigen::Vector3d size_of(std::span<const CloudPoint> points, const Eigen::Vector3d& up) {
  const Eigen::Quaterniond R_UW = shortest_rotation(up, Eigen::Vector3d::UnitZ());
  Eigen::AlignedBox3d box_U;
  for (const CloudPoint& point : points) {
    box_U.extend(Eigen::Vector3d(R_UW * position_of(point).cast<double>()));
  }
  return box_U.sizes();
}

}  // namespace kintsugi::segmenter
