#pragma once
// A room of boxes, and what a camera makes of it: a map with views, exact but for the grid.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "segmenter/views/observed_map.hpp"
#include "segmenter/views/observed_space.hpp"

namespace kintsugi::segmenter::testing {

/// Frame S of the room: x, y along the floor, z up.
struct Box {
  Eigen::Vector3d center_S;
  Eigen::Vector3d size_m;
  Eigen::Vector3i color{200, 60, 60};
  double yaw_rad = 0.0;

  [[nodiscard]] Pose X_SB() const {
    Pose X = Pose::Identity();
    X.linear() = Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    X.translation() = center_S;
    return X;
  }
};

struct ToyRoom {
  Eigen::Vector3d size_m{4.0, 3.0, 2.4};  ///< from the origin
  std::vector<Box> boxes;
  /// Of the walls x = 0, y = 0, x = most, y = most; then of floor and ceiling.
  std::vector<Eigen::Vector3i> colors{{200, 200, 190}, {190, 200, 200}, {200, 190, 200},
                                      {180, 200, 180}, {120, 100, 80},  {230, 230, 230}};
};

/// A table, a shelf, a cupboard and a bench; nothing is symmetric.
inline ToyRoom furnished_room() {
  ToyRoom room;
  room.boxes = {
      {.center_S = {1.4, 1.2, 0.375}, .size_m = {1.2, 0.7, 0.75}, .color = {150, 110, 60}},
      {.center_S = {3.75, 1.0, 0.9}, .size_m = {0.5, 1.2, 1.8}, .color = {90, 70, 50}},
      {.center_S = {0.5, 2.7, 0.6}, .size_m = {1.0, 0.6, 1.2}, .color = {60, 90, 140}},
      {.center_S = {2.8, 2.75, 0.25}, .size_m = {1.1, 0.5, 0.5}, .color = {140, 60, 60}},
  };
  return room;
}

/// Distance along the ray to the room's surface, in units of `direction`.
inline double distance_to(const ToyRoom& room, const Eigen::Vector3d& from_S,
                          const Eigen::Vector3d& direction_S) {
  double nearest = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {  // from inside, the first wall that is met
    const double end = direction_S[axis] > 0.0 ? room.size_m[axis] : 0.0;
    if (direction_S[axis] != 0.0) {
      nearest = std::min(nearest, (end - from_S[axis]) / direction_S[axis]);
    }
  }
  for (const Box& box : room.boxes) {
    const Pose X_BS = box.X_SB().inverse(Eigen::Isometry);
    const Eigen::Vector3d from = X_BS * from_S;
    const Eigen::Vector3d direction = X_BS.linear() * direction_S;
    double enter = 0.0;
    double leave = std::numeric_limits<double>::infinity();
    for (int axis = 0; axis < 3; ++axis) {
      const double half = 0.5 * box.size_m[axis];
      const double a = (-half - from[axis]) / direction[axis];
      const double b = (half - from[axis]) / direction[axis];
      enter = std::max(enter, std::min(a, b));
      leave = std::min(leave, std::max(a, b));
    }
    if (enter > 0.0 && enter < leave) nearest = std::min(nearest, enter);
  }
  return nearest;
}

/// A camera at `from_S` that looks at `at_S`, x of C level.
inline Pose looking_at(const Eigen::Vector3d& from_S, const Eigen::Vector3d& at_S) {
  const Eigen::Vector3d z = (at_S - from_S).normalized();
  const Eigen::Vector3d x = z.cross(Eigen::Vector3d::UnitZ()).normalized();
  Pose X_SC = Pose::Identity();
  X_SC.linear() << x, z.cross(x), z;
  X_SC.translation() = from_S;
  return X_SC;
}

/// A walk around the middle of the room at 1.5 m, looking over it and at the walls.
inline std::vector<Pose> walk_through(const ToyRoom& room, double phase_rad = 0.0,
                                      int num_views = 32) {
  const Eigen::Vector3d middle(0.5 * room.size_m.x(), 0.5 * room.size_m.y(), 0.0);
  std::vector<Pose> path;
  for (int i = 0; i < num_views; ++i) {
    const double angle = phase_rad + 2.0 * M_PI * i / num_views;
    const Eigen::Vector3d out(std::cos(angle), std::sin(angle), 0.0);
    const Eigen::Vector3d from = middle + 0.8 * out + Eigen::Vector3d(0, 0, 1.5);
    const double ahead = i % 2 == 0 ? -1.2 : 1.6;  // across the room, or at the wall
    path.push_back(looking_at(from, middle + ahead * out + Eigen::Vector3d(0, 0, 0.5)));
  }
  return path;
}

inline MapView view_of(const ToyRoom& room, const Pose& X_SC, std::int64_t utime) {
  MapView view;
  view.utime = utime;
  view.X_WC = X_SC;  // W is S here
  view.intrinsics = {.fx = 110, .fy = 110, .cx = 79.5, .cy = 59.5, .width = 160, .height = 120};
  for (int j = 0; j < view.intrinsics.height; ++j) {
    for (int i = 0; i < view.intrinsics.width; ++i) {
      const Eigen::Vector3d ray_C((i - 79.5) / 110, (j - 59.5) / 110, 1.0);
      const double z_m = distance_to(room, X_SC.translation(), X_SC.linear() * ray_C);
      view.depth_mm.push_back(static_cast<std::uint16_t>(std::lround(1e3 * z_m)));
    }
  }
  return view;
}

/// Adds a point for each cell of the rectangle, whose edges are u and v.
inline void add_face(const Eigen::Vector3d& corner_S, const Eigen::Vector3d& u,
                     const Eigen::Vector3d& v, const Eigen::Vector3d& normal,
                     const Eigen::Vector3i& color, std::uint32_t segment, double voxel_m,
                     ObservedMap& map) {
  const int rows = std::max(1, static_cast<int>(std::lround(u.norm() / voxel_m)));
  const int columns = std::max(1, static_cast<int>(std::lround(v.norm() / voxel_m)));
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const Eigen::Vector3d p = corner_S + (row + 0.5) / rows * u + (column + 0.5) / columns * v;
      CloudPoint point;
      point.x = static_cast<float>(p.x());
      point.y = static_cast<float>(p.y());
      point.z = static_cast<float>(p.z());
      point.nx = static_cast<float>(normal.x());
      point.ny = static_cast<float>(normal.y());
      point.nz = static_cast<float>(normal.z());
      point.red = static_cast<std::uint8_t>(color[0]);
      point.green = static_cast<std::uint8_t>(color[1]);
      point.blue = static_cast<std::uint8_t>(color[2]);
      point.weight = 1.0F;
      map.points_W.push_back(point);
      map.segment_ids.push_back(segment);
    }
  }
}

inline void add_surfaces(const ToyRoom& room, double voxel_m, ObservedMap& map) {
  std::uint32_t segment = 0;
  for (int axis = 0; axis < 3; ++axis) {  // walls, floor and ceiling
    const Eigen::Vector3d u = room.size_m[(axis + 1) % 3] * Eigen::Vector3d::Unit((axis + 1) % 3);
    const Eigen::Vector3d v = room.size_m[(axis + 2) % 3] * Eigen::Vector3d::Unit((axis + 2) % 3);
    const Eigen::Vector3d n = Eigen::Vector3d::Unit(axis);
    const std::size_t near = axis == 2 ? 4 : static_cast<std::size_t>(axis);
    const std::size_t far = axis == 2 ? 5 : static_cast<std::size_t>(axis) + 2;
    add_face(Eigen::Vector3d::Zero(), u, v, n, room.colors[near], ++segment, voxel_m, map);
    add_face(room.size_m[axis] * n, u, v, -n, room.colors[far], ++segment, voxel_m, map);
  }
  for (const Box& box : room.boxes) {
    ++segment;
    const Pose X_SB = box.X_SB();
    for (int axis = 0; axis < 3; ++axis) {
      for (const double side : {-1.0, 1.0}) {
        const Eigen::Vector3d u =
            box.size_m[(axis + 1) % 3] * Eigen::Vector3d::Unit((axis + 1) % 3);
        const Eigen::Vector3d v =
            box.size_m[(axis + 2) % 3] * Eigen::Vector3d::Unit((axis + 2) % 3);
        const Eigen::Vector3d n = side * Eigen::Vector3d::Unit(axis);
        const Eigen::Vector3d corner = 0.5 * box.size_m[axis] * n - 0.5 * (u + v);
        add_face(X_SB * corner, X_SB.linear() * u, X_SB.linear() * v, X_SB.linear() * n, box.color,
                 segment, voxel_m, map);
      }
    }
  }
}

/// The map of what the views of the path have measured. W is the first camera's frame. A box is a
/// segment, its number that of its place in the room, from 7.
inline ObservedMap observe(const ToyRoom& room, const std::vector<Pose>& path_S,
                           double voxel_m = 0.02) {
  ObservedMap all;
  add_surfaces(room, voxel_m, all);
  ObservedSpace space(voxel_m);
  ObservedMap map;
  map.source = "toy";
  map.resolution_m = static_cast<float>(voxel_m);
  for (std::size_t i = 0; i < path_S.size(); ++i) {
    map.views.push_back(view_of(room, path_S[i], 1000 * static_cast<std::int64_t>(i + 1)));
    space.add(map.views.back());
  }
  std::vector<Eigen::Vector3f> places;
  places.reserve(all.points_W.size());
  for (const CloudPoint& p : all.points_W) places.emplace_back(p.x, p.y, p.z);
  const std::vector<Sights> sights = space.sights(places);
  const Pose X_WS = path_S.front().inverse(Eigen::Isometry);
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (sights[i].measured == 0) continue;
    CloudPoint point = all.points_W[i];
    const Eigen::Vector3d p = X_WS * places[i].cast<double>();
    const Eigen::Vector3d n = X_WS.linear() * Eigen::Vector3d(point.nx, point.ny, point.nz);
    point.x = static_cast<float>(p.x());
    point.y = static_cast<float>(p.y());
    point.z = static_cast<float>(p.z());
    point.nx = static_cast<float>(n.x());
    point.ny = static_cast<float>(n.y());
    point.nz = static_cast<float>(n.z());
    map.points_W.push_back(point);
    map.segment_ids.push_back(all.segment_ids[i]);
  }
  for (MapView& view : map.views) view.X_WC = X_WS * view.X_WC;
  return map;
}

/// Another light: each channel brighter or darker.
inline void relight(ObservedMap& map, double red, double green, double blue) {
  for (CloudPoint& point : map.points_W) {
    point.red = static_cast<std::uint8_t>(std::min(255.0, red * point.red));
    point.green = static_cast<std::uint8_t>(std::min(255.0, green * point.green));
    point.blue = static_cast<std::uint8_t>(std::min(255.0, blue * point.blue));
  }
}

}  // namespace kintsugi::segmenter::testing
