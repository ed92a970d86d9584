#include "segmenter/objects/changes/map_changes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <utility>

#include "lcmtypes/scene/up_direction.hpp"
#include "segmenter/objects/changes/change_groups.hpp"
#include "segmenter/objects/changes/changed_points.hpp"
#include "segmenter/objects/changes/motion_between.hpp"
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

ObservedSpace space_of(const ObservedMap& map, const Pose& X_AW, double voxel_m) {
  ObservedSpace space(voxel_m);
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

struct Match {
  std::size_t gone = 0;
  std::size_t come = 0;
  ObjectMotion motion;
};

/// Pairs of things that are one, the surest first; each thing is in one pair at most.
std::vector<Match> matches_of(const std::vector<MapChange>& gone,
                              const std::vector<MapChange>& come, const Eigen::Vector3d& up_W,
                              double voxel_m) {
  std::vector<Match> all;
  for (std::size_t g = 0; g < gone.size(); ++g) {
    for (std::size_t c = 0; c < come.size(); ++c) {
      const auto motion = motion_between(gone[g].before, come[c].after, up_W, voxel_m);
      if (motion) all.push_back({g, c, *motion});
    }
  }
  std::ranges::stable_sort(all, std::ranges::greater{},
                           [](const Match& match) { return match.motion.score; });
  std::vector<Match> chosen;
  for (const Match& match : all) {
    const bool is_taken = std::ranges::any_of(chosen, [&](const Match& other) {
      return other.gone == match.gone || other.come == match.come;
    });
    if (!is_taken) chosen.push_back(match);
  }
  return chosen;
}

/// Makes one change of each pair: the thing that has come becomes one that has moved.
void join_moved(std::vector<MapChange>& gone, std::vector<MapChange>& come,
                const std::vector<Match>& matches) {
  std::vector<bool> is_joined(gone.size(), false);
  for (const Match& match : matches) {
    MapChange& from = gone[match.gone];
    MapChange& to = come[match.come];
    is_joined[match.gone] = true;
    to.kind = ChangeKind::kMoved;
    to.before = std::move(from.before);
    to.before_segments = std::move(from.before_segments);
    to.X_after_before = match.motion.X_after_before;
    to.score = match.motion.score;
  }
  for (std::size_t i = 0; i < gone.size(); ++i) {
    if (!is_joined[i]) come.push_back(std::move(gone[i]));
  }
}

}  // namespace

MapChanges find_changes(const ObservedMap& before, const ObservedMap& after, const Pose& X_AB) {
  const double voxel_m = std::max(before.resolution_m, after.resolution_m);
  const std::vector<CloudPoint> before_A = transformed(X_AB, before.points_W);
  const auto gone_points =
      changes_of(before_A, after.points_W, space_of(after, Pose::Identity(), voxel_m), voxel_m);
  const auto new_points =
      changes_of(after.points_W, before_A, space_of(before, X_AB, voxel_m), voxel_m);
  MapChanges result;
  result.not_seen_again = num_unknown(gone_points);
  result.not_seen_before = num_unknown(new_points);
  const auto gains = gains_of(before_A, after.points_W, voxel_m);
  std::vector<MapChange> gone;
  for (const ChangeGroup& group :
       group_changes(before_A, before.segment_ids, gone_points, voxel_m)) {
    MapChange& change = gone.emplace_back();
    change.kind = ChangeKind::kGone;
    change.before = chosen(before_A, group.points);
    change.before_segments = group.segment_ids;
    change.score = group.share_changed;
  }
  std::vector<MapChange>& come = result.changes;
  for (const ChangeGroup& group :
       group_changes(after.points_W, after.segment_ids, new_points, voxel_m)) {
    MapChange& change = come.emplace_back();
    change.kind = ChangeKind::kNew;
    change.after = chosen(after.points_W, group.points);
    change.after_segments = group.segment_ids;
    change.score = group.share_changed;
  }
  UpDirection up;
  up.add(after.points_W);
  std::vector<MapChange> relit = gone;
  for (MapChange& change : relit) relight(change.before, gains);
  join_moved(gone, come, matches_of(relit, come, up.up_W(), voxel_m));
  std::ranges::stable_sort(come, std::ranges::greater{},
                           [](const MapChange& change) { return change.points().size(); });
  std::int32_t id = 0;
  for (MapChange& change : come) change.id = ++id;
  return result;
}

}  // namespace kintsugi::segmenter
