#include "tests/viewer/support/synthetic_room.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>

namespace kintsugi::viewer {
namespace {

constexpr std::int64_t kMapSession = 1'000;
constexpr std::int64_t kSegmenterSession = 2'000;
constexpr double kSliceLength_m = 0.25;
constexpr double kHalfWidth_m = 2.5;
constexpr double kFloor_m = 1.3;  // y is down
constexpr double kCeiling_m = -1.3;
constexpr double kSpeed_m_per_s = 0.5;

using Rgb = std::array<int, 3>;

struct LabelledPoint {
  CloudPoint point;
  std::uint32_t segment_id = 0;
};

/// Samples surfaces once per voxel, jittered in position and brightness.
class Sampler {
 public:
  explicit Sampler(double resolution_m) : resolution_m_(resolution_m) {}

  /// A parallelogram from `corner` along two edges; its normal is along a x b.
  void plane(const Eigen::Vector3d& corner, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
             const Rgb& color, std::uint32_t id) {
    const Eigen::Vector3d normal = a.cross(b).normalized();
    const int n = static_cast<int>(std::ceil(a.norm() / resolution_m_));
    const int m = static_cast<int>(std::ceil(b.norm() / resolution_m_));
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < m; ++j)
        add(corner + a * (i + 0.5) / n + b * (j + 0.5) / m, normal, color, id);
    }
  }

  void box(const Eigen::Vector3d& center, const Eigen::Vector3d& half, const Rgb& color,
           std::uint32_t id) {
    for (int axis = 0; axis < 3; ++axis) {
      for (const double side : {-1.0, 1.0}) {
        const int next = (axis + 1) % 3;
        const int last = (axis + 2) % 3;
        Eigen::Vector3d a = 2.0 * half[next] * Eigen::Vector3d::Unit(next);
        Eigen::Vector3d b = 2.0 * half[last] * Eigen::Vector3d::Unit(last);
        if (side < 0.0) std::swap(a, b);  // the normal a x b points out of the box
        const Eigen::Vector3d face = center + side * half[axis] * Eigen::Vector3d::Unit(axis);
        plane(face - 0.5 * (a + b), a, b, color, id);
      }
    }
  }

  /// Points on a Fibonacci spiral.
  void ball(const Eigen::Vector3d& center, double radius_m, const Rgb& color, std::uint32_t id) {
    const double area = 4.0 * std::numbers::pi * radius_m * radius_m;
    const int n = static_cast<int>(area / (resolution_m_ * resolution_m_));
    for (int i = 0; i < n; ++i) {
      const double y = 1.0 - 2.0 * (i + 0.5) / n;
      const double angle = i * std::numbers::pi * (3.0 - std::sqrt(5.0));
      const double r = std::sqrt(1.0 - y * y);
      const Eigen::Vector3d normal(r * std::cos(angle), y, r * std::sin(angle));
      add(center + radius_m * normal, normal, color, id);
    }
  }

  std::vector<LabelledPoint> take() { return std::move(points_); }

 private:
  void add(const Eigen::Vector3d& p, const Eigen::Vector3d& n, const Rgb& color, std::uint32_t id) {
    std::uniform_real_distribution<double> jitter(-0.15 * resolution_m_, 0.15 * resolution_m_);
    std::uniform_int_distribution<int> shade(-8, 8);
    const Eigen::Vector3f q =
        (p + Eigen::Vector3d(jitter(random_), jitter(random_), jitter(random_))).cast<float>();
    const Eigen::Vector3f m = n.cast<float>();
    const int s = shade(random_);
    const auto channel = [&](int i) {
      return static_cast<std::uint8_t>(std::clamp(color[static_cast<std::size_t>(i)] + s, 0, 255));
    };
    points_.push_back({{.x = q.x(),
                        .y = q.y(),
                        .z = q.z(),
                        .nx = m.x(),
                        .ny = m.y(),
                        .nz = m.z(),
                        .red = channel(0),
                        .green = channel(1),
                        .blue = channel(2),
                        .weight = 20.0F},
                       id});
  }

  double resolution_m_;
  std::mt19937 random_{7};
  std::vector<LabelledPoint> points_;
};

std::vector<LabelledPoint> sample_room(double length_m, double resolution_m) {
  const double w = 2.0 * kHalfWidth_m;
  const double h = kFloor_m - kCeiling_m;
  const Eigen::Vector3d x = w * Eigen::Vector3d::UnitX();
  const Eigen::Vector3d y = h * Eigen::Vector3d::UnitY();
  const Eigen::Vector3d z = length_m * Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d low(-kHalfWidth_m, kCeiling_m, 0.0);
  const Eigen::Vector3d high(kHalfWidth_m, kFloor_m, length_m);

  Sampler room(resolution_m);
  room.plane(high - x - z, x, z, {150, 118, 84}, 1);  // floor, normal up
  room.plane(low, z, x, {235, 235, 230}, 2);          // ceiling, normal down
  room.plane(low, y, z, {205, 196, 178}, 3);          // left wall
  room.plane(low + x, z, y, {205, 196, 178}, 4);      // right wall
  room.plane(low, x, y, {188, 200, 205}, 5);          // wall behind the start, normal along +z
  room.plane(low + z, y, x, {188, 200, 205}, 6);      // far wall
  std::uint32_t id = 7;
  for (double at = 1.25; at + 0.8 < length_m; at += 2.5) {
    const double side = std::fmod(at, 5.0) < 2.5 ? -1.0 : 1.0;
    const Eigen::Vector3d desk(1.7 * side, kFloor_m - 0.72, at);
    room.box(desk, {0.7, 0.03, 0.6}, {120, 72, 40}, id++);
    for (const double dx : {-0.6, 0.6}) {
      room.box(desk + Eigen::Vector3d(dx, 0.375, 0.0), {0.04, 0.345, 0.5}, {60, 60, 66}, id++);
    }
    room.ball(desk + Eigen::Vector3d(-0.2, -0.15, 0.2), 0.12, {200, 40, 40}, id++);
    room.box(desk + Eigen::Vector3d(0.2, -0.18, -0.15), {0.15, 0.15, 0.1}, {40, 90, 170}, id++);
  }
  return room.take();
}

Pose camera_at(double z_m) {
  Pose X_WC = Pose::Identity();
  X_WC.translation() = Eigen::Vector3d(0.4 * std::sin(z_m), 0.0, z_m);
  X_WC.linear() =
      Eigen::AngleAxisd(0.3 * std::cos(z_m), Eigen::Vector3d::UnitY()).toRotationMatrix();
  return X_WC;
}

std::int64_t utime_at(double z_m) {
  return 1'000'000 + static_cast<std::int64_t>(1e6 * z_m / kSpeed_m_per_s);
}

}  // namespace

SyntheticMap make_room(double length_m, double resolution_m) {
  const auto count = static_cast<std::size_t>(std::ceil(length_m / kSliceLength_m));
  SyntheticMap map;
  map.slices.resize(count);
  map.updates.resize(count);
  std::int64_t num_points = 0;
  for (const LabelledPoint& p : sample_room(length_m, resolution_m)) {
    const auto slab = static_cast<std::ptrdiff_t>(std::floor(p.point.z / kSliceLength_m));
    const auto slice = static_cast<std::size_t>(
        std::clamp<std::ptrdiff_t>(slab, 0, static_cast<std::ptrdiff_t>(count) - 1));
    map.slices[slice].points_W.push_back(p.point);
    map.updates[slice].labels.push_back(p.segment_id);
  }
  for (std::size_t i = 0; i < count; ++i) {
    const double camera_z_m =
        std::min((static_cast<double>(i) + 1.0) * kSliceLength_m + 1.0, length_m - 0.5);
    CloudSlice& slice = map.slices[i];
    slice.utime = utime_at(camera_z_m);
    slice.session = kMapSession;
    slice.map_name = "room";
    slice.id = static_cast<std::int32_t>(i);
    slice.kind = i + 1 == count ? SliceKind::kFinal : SliceKind::kShiftPlusZ;
    slice.resolution_m = static_cast<float>(resolution_m);
    slice.X_WC = camera_at(camera_z_m);
    num_points += static_cast<std::int64_t>(slice.points_W.size());

    SegmentUpdate& update = map.updates[i];
    update.utime = slice.utime;
    update.session = kSegmenterSession;
    update.sequence = slice.id;
    update.map_session = kMapSession;
    update.map_name = slice.map_name;
    update.slice_id = slice.id;
    update.is_final = slice.kind == SliceKind::kFinal;
    update.num_slices = slice.id + 1;
    update.num_points = num_points;
    update.num_segments = *std::ranges::max_element(update.labels);
  }
  for (int frame = 0; frame * kSpeed_m_per_s / 30.0 < length_m - 0.5; ++frame) {
    const double z_m = frame * kSpeed_m_per_s / 30.0;
    map.poses.push_back({.utime = utime_at(z_m),
                         .session = kMapSession,
                         .frame_index = frame,
                         .state = TrackingState::kTracking,
                         .X_WC = camera_at(z_m)});
  }
  return map;
}

}  // namespace kintsugi::viewer
