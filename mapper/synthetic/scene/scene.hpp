#pragma once
// A union of solids: what a ray meets, and how far a point is from the nearest surface.

#include <Eigen/Geometry>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "lcmtypes/geometry.hpp"
#include "mapper/synthetic/scene/material.hpp"
#include "mapper/synthetic/scene/shape.hpp"

namespace kintsugi::synthetic {

class Bvh;

/// Instance id of a pixel or ray that meets nothing. Instances start at 1.
inline constexpr int kNoInstance = 0;

/// One solid of the scene; an object (instance) may be made of several.
struct Primitive {
  Shape shape;
  Pose X_WO = Pose::Identity();  ///< O is the shape's own frame
  Material material;
  int instance = kNoInstance;
};

/// One object, as a person would count it: a chair, a mug, a wall.
struct Instance {
  int id = kNoInstance;  ///< index in Scene::instances() + 1
  std::string name;      ///< "mug"; not unique
  std::string shape;     ///< of its first solid: "cylinder", ...
  Color color = Color::Zero();
  /// Of the building: floor, wall, ceiling, stairs, what is built into a wall. The others are what
  /// a person could name and pick up, push or take off its nail.
  bool is_structure = false;
};

struct RayHit {
  double t = 0.0;  ///< p_W = origin_W + t * direction_W
  Eigen::Vector3d p_W = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal_W = Eigen::Vector3d::Zero();  ///< unit, outward
  int instance = kNoInstance;
  int primitive = -1;  ///< index in Scene::primitives()
};

/// How far a point is from the surface of a scene, and whose surface it is.
struct SurfaceDistance {
  double signed_m = std::numeric_limits<double>::infinity();  ///< as Scene::signed_distance()
  int instance = kNoInstance;                                 ///< only of an empty scene none
};

/// A scene in its own frame W: z up, the floor of the first storey at z = 0, metres.
///
/// This is the frame of every ground truth. A mapper that tracks starts its map frame at the first
/// camera pose instead: align before comparing, or give it the true poses.
/// Immutable; every method is const and may be called from several threads.
class Scene {
 public:
  /// Throws std::invalid_argument if a primitive's instance does not exist.
  Scene(std::vector<Primitive> primitives, std::vector<Instance> instances);
  ~Scene();
  Scene(Scene&&) noexcept;
  Scene& operator=(Scene&&) noexcept;

  const std::vector<Primitive>& primitives() const { return primitives_; }
  const std::vector<Instance>& instances() const { return instances_; }

  /// The first surface that the ray enters from outside, or nothing. The direction need not be a
  /// unit vector. Solids that contain the origin are not seen.
  std::optional<RayHit> intersect(const Eigen::Vector3d& origin_W,
                                  const Eigen::Vector3d& direction_W) const;

  /// Distance from p_W to the nearest surface of the union, metres, positive in free space and
  /// there exact. Negative inside: then it is minus the depth in the solid that holds p_W deepest,
  /// which is exact while the nearest surface of that solid is also a surface of the union (that
  /// is, away from where solids touch or overlap). Infinity for an empty scene.
  double signed_distance(const Eigen::Vector3d& p_W) const;

  /// The same, with the instance of the solid it is measured to; of solids equally near that of the
  /// first in the list, whose surface is also the one that is seen.
  SurfaceDistance nearest_surface(const Eigen::Vector3d& p_W) const;

 private:
  std::vector<Primitive> primitives_;
  std::vector<Instance> instances_;
  std::unique_ptr<Bvh> bvh_;
};

}  // namespace kintsugi::synthetic
