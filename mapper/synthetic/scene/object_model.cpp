#include "mapper/synthetic/scene/object_model.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>

#include "mapper/synthetic/scene/material.hpp"
#include "mapper/synthetic/scene/shape.hpp"

namespace kintsugi::synthetic {

namespace {

constexpr double kSame = 1e-6;  // metres, and parts of 1: what rounding may change

/// The solids of an instance with their poses in its frame G.
std::vector<Primitive> solids_in_G(const Instance& instance,
                                   const std::vector<Primitive>& primitives) {
  std::vector<Primitive> solids;
  std::ranges::copy_if(primitives, std::back_inserter(solids),
                       [&](const Primitive& p) { return p.instance == instance.id; });
  for (Primitive& solid : solids) solid.X_WO = instance.X_WG.inverse() * solid.X_WO;
  return solids;
}

Eigen::AlignedBox3d bounding_box(const std::vector<Primitive>& solids) {
  Eigen::AlignedBox3d box;
  for (const Primitive& solid : solids) {
    const Eigen::Vector3d reach = solid.X_WO.linear().cwiseAbs() * solid.shape.half_extents;
    box.extend(Eigen::Vector3d(solid.X_WO.translation() - reach));
    box.extend(Eigen::Vector3d(solid.X_WO.translation() + reach));
  }
  return box;
}

std::string word_for(const Color& color) {
  struct Word {
    const char* word;
    Color color;
  };
  const auto level = [](int r, int g, int b) -> Color {
    return Eigen::Vector3i(r, g, b).cast<float>() / 255.0F;
  };
  static const std::array<Word, 13> kWords = {{{"black", level(45, 45, 50)},
                                               {"grey", level(125, 125, 125)},
                                               {"white", level(240, 240, 235)},
                                               {"red", level(200, 45, 45)},
                                               {"brown", level(120, 80, 50)},
                                               {"tan", level(200, 155, 100)},
                                               {"orange", level(235, 125, 40)},
                                               {"yellow", level(235, 190, 60)},
                                               {"green", level(60, 140, 75)},
                                               {"teal", level(40, 145, 160)},
                                               {"blue", level(45, 90, 180)},
                                               {"purple", level(125, 65, 150)},
                                               {"pink", level(214, 96, 140)}}};
  return std::ranges::min_element(kWords, {},
                                  [&](const Word& w) { return (w.color - color).squaredNorm(); })
      ->word;
}

bool is_round(ShapeKind kind) { return kind != ShapeKind::kBox && kind != ShapeKind::kRoundedBox; }

/// Whether a shape that is turned by R about its own centre fills the same space.
bool fits_itself(const Shape& shape, const Eigen::Matrix3d& R) {
  switch (shape.kind) {
    case ShapeKind::kSphere:
      return true;
    case ShapeKind::kCone:
      return R(2, 2) > 1.0 - kSame;
    case ShapeKind::kCylinder:
    case ShapeKind::kCapsule:
    case ShapeKind::kTorus:
      return std::abs(R(2, 2)) > 1.0 - kSame;
    case ShapeKind::kBox:
    case ShapeKind::kRoundedBox: {
      const Eigen::Matrix3d sizes = R.cwiseAbs();
      const bool is_along_axes = (sizes.array().min(1.0 - sizes.array()) < kSame).all();
      return is_along_axes && (sizes * shape.half_extents).isApprox(shape.half_extents, kSame);
    }
  }
  return false;
}

bool are_same_make(const Primitive& a, const Primitive& b) {
  return a.shape.kind == b.shape.kind &&
         a.shape.half_extents.isApprox(b.shape.half_extents, kSame) &&
         std::abs(a.shape.radius - b.shape.radius) < kSame &&
         std::abs(a.shape.second_radius - b.shape.second_radius) < kSame &&
         a.material.color == b.material.color;
}

bool is_same_after(const Pose& turn, const std::vector<Primitive>& solids) {
  return std::ranges::all_of(solids, [&](const Primitive& solid) {
    const Pose X_GO = turn * solid.X_WO;
    return std::ranges::any_of(solids, [&](const Primitive& other) {
      return are_same_make(solid, other) &&
             (X_GO.translation() - other.X_WO.translation()).norm() < kSame &&
             fits_itself(solid.shape, other.X_WO.linear().transpose() * X_GO.linear());
    });
  });
}

/// Whether all solids are round about the line along `direction` through `centre`.
bool is_round_about(const Eigen::Vector3d& centre, const Eigen::Vector3d& direction,
                    const std::vector<Primitive>& solids) {
  return std::ranges::all_of(solids, [&](const Primitive& solid) {
    const Eigen::Vector3d from_centre = solid.X_WO.translation() - centre;
    const bool is_on_line = from_centre.cross(direction).norm() < kSame;
    const double along = std::abs(solid.X_WO.linear().col(2).dot(direction));
    return is_on_line && is_round(solid.shape.kind) &&
           (solid.shape.kind == ShapeKind::kSphere || along > 1.0 - kSame);
  });
}

}  // namespace

std::string model_of(const Instance& instance, const std::vector<Primitive>& primitives) {
  const Eigen::Vector3d size_m = bounding_box(solids_in_G(instance, primitives)).sizes();
  const auto mm = [&](int axis) { return std::to_string(std::lround(1000.0 * size_m[axis])); };
  return instance.name + ' ' + word_for(instance.color) + ' ' + mm(0) + 'x' + mm(1) + 'x' + mm(2);
}

Symmetry symmetry_of(const Instance& instance, const std::vector<Primitive>& primitives) {
  const std::vector<Primitive> solids = solids_in_G(instance, primitives);
  Symmetry symmetry{.centre_G = bounding_box(solids).center(), .axes = {}};
  const auto turn_about_centre = [&](const Eigen::Vector3d& direction, int order) {
    const Eigen::AngleAxisd turn(2.0 * std::numbers::pi / order, direction);
    return Pose(Eigen::Translation3d(symmetry.centre_G) * turn *
                Eigen::Translation3d(-symmetry.centre_G));
  };
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d direction = Eigen::Vector3d::Unit(axis);
    if (is_round_about(symmetry.centre_G, direction, solids)) {
      symmetry.axes.push_back({direction, kAnyAngle});
      continue;
    }
    for (const int order : {4, 2}) {
      if (!is_same_after(turn_about_centre(direction, order), solids)) continue;
      symmetry.axes.push_back({direction, order});
      break;
    }
  }
  return symmetry;
}

}  // namespace kintsugi::synthetic
