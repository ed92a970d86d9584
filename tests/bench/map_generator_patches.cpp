#include "tests/bench/map_generator_patches.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <tuple>

namespace kintsugi::segmenter::bench {
namespace {

using Cell = std::tuple<int, int, int>;

Cell cell_of(const CloudPoint& p, double side_m) {
  const auto cell = [&](float v) { return static_cast<int>(std::floor(v / side_m)); };
  return {cell(p.x), cell(p.y), cell(p.z)};
}

Pose place_on_arc(const CloudSlice& patch, double curvature_per_m) {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const CloudPoint& p : patch.points_W) middle += Eigen::Vector3d(p.x, p.y, p.z);
  middle /= static_cast<double>(patch.points_W.size());
  const double angle = curvature_per_m * middle.x();
  Pose X = Pose::Identity();
  X.linear() = Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()).matrix();
  const Eigen::Vector3d on_arc =
      Eigen::Vector3d(std::sin(angle), 1.0 - std::cos(angle), 0.0) / curvature_per_m;
  X.translation() = on_arc - X.linear() * Eigen::Vector3d(middle.x(), 0.0, 0.0);
  return X;
}

}  // namespace

std::vector<CloudSlice> cut_into_patches(const Slices& slices, double tile_m, double voxel_m) {
  struct Place {
    Cell tile;
    Cell voxel;
    std::size_t point;

    bool operator<(const Place& other) const {
      return std::tie(tile, voxel, point) < std::tie(other.tile, other.voxel, other.point);
    }
  };
  const std::vector<CloudPoint> points = all_points(slices);
  std::vector<Place> places;
  places.reserve(points.size());
  for (const CloudPoint& p : points) {
    places.push_back({cell_of(p, tile_m), cell_of(p, voxel_m), places.size()});
  }
  std::sort(places.begin(), places.end());

  std::vector<CloudSlice> patches;
  const Place* last = nullptr;
  for (const Place& place : places) {
    const bool is_same_tile = last != nullptr && place.tile == last->tile;
    if (is_same_tile && place.voxel == last->voxel) continue;
    if (!is_same_tile) {
      CloudSlice& patch = patches.emplace_back();
      patch.session = 1;
      patch.id = static_cast<std::int32_t>(patches.size()) - 1;
      patch.kind = SliceKind::kPatch;
      patch.in_volume = true;
      patch.resolution_m = static_cast<float>(voxel_m);
    }
    patches.back().points_W.push_back(points[place.point]);
    last = &place;
  }
  return patches;
}

CloudSlice correction_to_arc(std::span<const CloudSlice> patches, double curvature_per_m,
                             std::int32_t id, std::int32_t number) {
  CloudSlice correction;
  correction.session = patches.front().session;
  correction.map_name = patches.front().map_name;
  correction.kind = SliceKind::kCorrection;
  correction.ends_batch = true;
  correction.resolution_m = patches.front().resolution_m;
  correction.id = id;
  correction.correction = number;
  for (const CloudSlice& patch : patches) {
    correction.motions.push_back({patch.id, place_on_arc(patch, curvature_per_m)});
  }
  return correction;
}

}  // namespace kintsugi::segmenter::bench
