#include "tests/fuzz/random_cloud.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "tests/segmenter/core/random_clouds.hpp"

namespace kintsugi::segmenter::fuzz {
namespace {

using testing::CloudShape;
using testing::colored_as;
using testing::make_point;

/// The points of a cube around a random one.
std::vector<CloudPoint> piece_of_map(Random& random, std::size_t num_points,
                                     std::span<const CloudPoint> map_W) {
  const CloudPoint& centre = map_W[random.below(map_W.size())];
  // A surface has about three crossings for each voxel.
  const double half_m = 0.5 * kResolution_m * std::sqrt(static_cast<double>(num_points) / 3.0);
  std::vector<CloudPoint> piece;
  for (const CloudPoint& p : map_W) {
    const bool is_inside = std::abs(p.x - centre.x) <= half_m &&
                           std::abs(p.y - centre.y) <= half_m && std::abs(p.z - centre.z) <= half_m;
    if (is_inside) piece.push_back(p);
    if (piece.size() == 2 * num_points) break;
  }
  return piece;
}

CloudPoint upright_point(double x, double y, double z) { return make_point(x, y, z, 0, 0, 1); }

/// Points in a row, of which some have no neighbour, most one or two on either side.
std::vector<CloudPoint> line(Random& random, std::size_t num_points) {
  std::vector<CloudPoint> points;
  double x = 0.0;
  for (std::size_t k = 0; k < num_points; ++k) {
    x += random.uniform(0.4, random.chance(0.05) ? 2.2 : 1.6) * kResolution_m;
    points.push_back(upright_point(x, 0.0, 0.0));
  }
  return points;
}

/// Points in a box, each with about ten neighbours.
std::vector<CloudPoint> clump(Random& random, std::size_t num_points, double first_x_m) {
  const double side_m = 1.5 * kResolution_m * std::cbrt(static_cast<double>(num_points));
  const auto coordinate = [&] { return random.uniform(0.0, side_m); };
  std::vector<CloudPoint> points;
  for (std::size_t k = 0; k < num_points; ++k) {
    const double x = first_x_m + coordinate();
    const double y = coordinate();
    points.push_back(upright_point(x, y, coordinate()));
  }
  return points;
}

/// Clumps along x, a bridge of few points from each to the next.
std::vector<CloudPoint> bridged_clumps(Random& random, std::size_t num_points) {
  const std::size_t num_clumps = random.between(2, 5);
  const std::size_t clump_points = num_points / num_clumps + 1;
  const double side_m = 1.5 * kResolution_m * std::cbrt(static_cast<double>(clump_points));
  const double gap_m = 4.0 * kResolution_m;
  std::vector<CloudPoint> points;
  for (std::size_t c = 0; c < num_clumps; ++c) {
    const double first_x_m = static_cast<double>(c) * (side_m + gap_m);
    for (const CloudPoint& p : clump(random, clump_points, first_x_m)) points.push_back(p);
    if (c == 0) continue;
    for (double x = first_x_m - gap_m; x < first_x_m; x += 1.5 * kResolution_m) {
      points.push_back(upright_point(x, 0.5 * side_m, 0.5 * side_m));
    }
  }
  return points;
}

/// Normals and places snapped to few values: many weights and distances are equal.
void tie(Random& random, std::vector<CloudPoint>& points) {
  const double tilt = random.pick(std::vector<double>{0.0, 0.01, 0.03, 0.1});
  const bool snaps_places = random.chance(0.5);
  const double step_m = 0.75 * kResolution_m;
  const auto snap = [&](float x) { return snaps_places ? std::round(x / step_m) * step_m : x; };
  for (CloudPoint& p : points) {
    const double slope_x = tilt * static_cast<double>(random.below(3));
    const double slope_y = tilt * static_cast<double>(random.below(2));
    p = colored_as(p, make_point(snap(p.x), snap(p.y), snap(p.z), slope_x, slope_y, 1.0));
  }
}

/// Each normal tilted on its own: weights of all magnitudes around and below the thresholds.
void tilt(Random& random, std::vector<CloudPoint>& points) {
  const double most = random.log_uniform(0.005, 0.2);
  for (CloudPoint& p : points) {
    const double angle = random.uniform(0.0, 6.3);
    const double slope = random.log_uniform(1e-2 * most, most);
    p = colored_as(
        p, make_point(p.x, p.y, p.z, slope * std::cos(angle), slope * std::sin(angle), 1.0));
  }
}

/// Spots of a colour or of none, with noise or (many equal differences) without.
void paint(Random& random, std::vector<CloudPoint>& points) {
  constexpr std::size_t kColors = 4;
  std::array<std::array<double, 3>, kColors> palette{};
  for (std::size_t k = 1; k < kColors; ++k) {  // the first is black: no colour
    for (double& channel : palette[k]) channel = random.uniform(0.0, 255.0);
  }
  const double noise = random.pick(std::vector<double>{0.0, 2.0, 20.0});
  const double spot_m = random.log_uniform(0.5, 20.0) * kResolution_m;
  const auto cell = [&](float x) { return static_cast<std::size_t>(std::abs(x) / spot_m); };
  for (CloudPoint& p : points) {
    const std::size_t color = (cell(p.x) + 3 * cell(p.y) + cell(p.z)) % kColors;
    const auto channel = [&](std::size_t c) {
      const double shade = color == 0 ? 0.0 : random.uniform(-noise, noise);
      return static_cast<std::uint8_t>(std::clamp(palette[color][c] + shade, 0.0, 255.0));
    };
    p.red = channel(0);
    p.green = channel(1);
    p.blue = channel(2);
  }
}

void arrange(Random& random, std::vector<CloudPoint>& points) {
  if (random.chance(0.5)) return random.shuffle(points);
  constexpr std::array kAxes = {&CloudPoint::x, &CloudPoint::y, &CloudPoint::z};
  std::ranges::stable_sort(points, {}, kAxes[random.below(kAxes.size())]);
}

}  // namespace

std::vector<CloudPoint> random_cloud(Random& random, std::size_t num_points,
                                     std::span<const CloudPoint> map_W) {
  std::vector<CloudPoint> points;
  bool has_weights = true;  // of the kind that the surface gives
  if (!map_W.empty() && random.chance(0.6)) {
    points = piece_of_map(random, num_points, map_W);
  } else if (random.chance(0.4)) {
    const auto shape =
        random.pick(std::vector{CloudShape::kWaves, CloudShape::kLattice, CloudShape::kUnrelated});
    points = testing::random_cloud(shape, static_cast<int>(num_points),
                                   static_cast<unsigned>(random.below(1U << 30U)), kResolution_m);
  } else {
    has_weights = false;
    switch (random.below(3)) {
      case 0:
        points = line(random, num_points);
        break;
      case 1:
        points = clump(random, num_points, 0.0);
        break;
      default:
        points = bridged_clumps(random, num_points);
    }
  }
  const double kind = random.unit();
  if (kind < 0.2) {
    tie(random, points);
  } else if (!has_weights || kind < 0.55) {
    tilt(random, points);
  }
  if (random.chance(0.7)) paint(random, points);
  arrange(random, points);
  return points;
}

}  // namespace kintsugi::segmenter::fuzz
