#include "tests/support/played_map.hpp"

#include <algorithm>
#include <span>
#include <utility>

#include "tests/bench/map_generator.hpp"

namespace kintsugi::testing {
namespace {

using Points = std::vector<CloudPoint>;

constexpr float kResolution_m = 0.01F;  // of the generated map
constexpr float kShift_m = 0.01F;
constexpr std::int64_t kFirstUtime = 1'000'000;

/// Cuts the slices, in the order of their points.
std::vector<Points> cut(const std::vector<Points>& slices, std::size_t most_points) {
  std::vector<Points> pieces;
  for (const Points& slice : slices) {
    for (std::size_t first = 0; first < slice.size(); first += most_points) {
      const auto rest = std::span(slice).subspan(first);
      const auto piece = rest.first(std::min(most_points, rest.size()));
      pieces.emplace_back(piece.begin(), piece.end());
    }
  }
  return pieces;
}

std::vector<Points> generate(const PlayedMap::Config& config) {
  segmenter::bench::MapConfig map;
  map.num_points = config.num_points;
  map.num_rooms = config.num_rooms;
  map.seed = config.seed;
  std::vector<Points> slices;
  Points slice;
  for (const Points& part : segmenter::bench::generate_map(map)) {
    slice.insert(slice.end(), part.begin(), part.end());
    if (slice.size() >= config.slice_points) slices.push_back(std::exchange(slice, {}));
  }
  if (!slice.empty() || slices.empty()) slices.push_back(std::move(slice));
  return config.most_points > 0 ? cut(slices, config.most_points) : slices;
}

/// A camera a metre above the middle of what it sees.
Pose camera_over(const Points& points_W) {
  Eigen::Vector3d sum_W = Eigen::Vector3d::Zero();
  for (const CloudPoint& p : points_W) sum_W += Eigen::Vector3d(p.x, p.y, p.z);
  Pose X_WC = Pose::Identity();
  if (!points_W.empty()) X_WC.translation() = sum_W / static_cast<double>(points_W.size());
  X_WC.translation().z() += 1.0;
  return X_WC;
}

}  // namespace

PlayedMap::PlayedMap(const Config& config) : config_(config), slices_(generate(config)) {}

CloudSlice PlayedMap::slice(std::int32_t id, std::int32_t revision) const {
  CloudSlice slice;
  slice.session = config_.session;
  slice.map_name = config_.map_name;
  slice.id = id;
  slice.revision = revision;
  slice.kind = id + 1 == num_slices() ? SliceKind::kFinal : SliceKind::kShiftPlusX;
  slice.utime =
      kFirstUtime + static_cast<std::int64_t>(1e6 / kNormalSlicesPerSecond) * std::int64_t{id};
  slice.resolution_m = kResolution_m;
  slice.points_W = slices_.at(static_cast<std::size_t>(id));
  slice.X_WC = camera_over(slice.points_W);
  if (revision % 2 == 1) {
    for (CloudPoint& point : slice.points_W) point.x += kShift_m;
  }
  return slice;
}

}  // namespace kintsugi::testing
