#pragma once
// A union of solids: intersections with rays, and distances of points from the surface.

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

/// Instance id of a pixel or ray that meets no surface. Instances start at 1.
inline constexpr int kNoInstance = 0;

/// One solid of the scene; an object (instance) may be made of several.
struct Primitive {
  Shape shape;
  Pose X_WO = Pose::Identity();  ///< O is the shape's own frame
  Material material;
  int instance = kNoInstance;
};

/// One object in the everyday sense: a chair, a mug, a wall.
struct Instance {
  int id = kNoInstance;  ///< index in Scene::instances() + 1
  std::string name;      ///< "mug"; not unique
  /// Name, colour and size: "mug red 128x90x105". Things of the same make have the same model, in
  /// any scene; see model_of().
  std::string model;
  /// Its own in a scene, and the same in scenes of the same room at other times: the model, with a
  /// number from the second of its make on ("globe blue 220x220x300 2").
  std::string key;
  Pose X_WG = Pose::Identity();  ///< of its own frame G, in which things of one model are alike
  std::string shape;             ///< of its first solid: "cylinder", ...
  Color color = Color::Zero();
  /// Part of the building: floor, wall, ceiling, stairs, door, window. Otherwise it is an object
  /// that could be moved.
  bool is_structure = false;
};

struct RayHit {
  double t = 0.0;  ///< p_W = origin_W + t * direction_W
  Eigen::Vector3d p_W = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal_W = Eigen::Vector3d::Zero();  ///< unit, outward
  int instance = kNoInstance;
  int primitive = -1;  ///< index in Scene::primitives()
};

/// Distance of a point from the surface of a scene, and the instance that the surface belongs to.
struct SurfaceDistance {
  double signed_m = std::numeric_limits<double>::infinity();  ///< as Scene::signed_distance()
  int instance = kNoInstance;  ///< kNoInstance only for an empty scene
};

/// A scene in its own frame W: z up, the floor of the first storey at z = 0, metres.
///
/// Every ground truth is in this frame. The map frame of a mapper is that of the camera at its
/// first frame, unless it was given the true poses: align before you compare.
/// Immutable; every method is const and may be called from several threads.
class Scene {
 public:
  /// @param light factor of all colours: brightness and tint of the light in the room
  /// @throws std::invalid_argument if a primitive's instance does not exist.
  Scene(std::vector<Primitive> primitives, std::vector<Instance> instances,
        const Color& light = Color::Ones());
  ~Scene();
  Scene(Scene&&) noexcept;
  Scene& operator=(Scene&&) noexcept;

  const std::vector<Primitive>& primitives() const { return primitives_; }
  const std::vector<Instance>& instances() const { return instances_; }
  const Color& light() const { return light_; }

  /// The first surface that the ray enters from outside, or nothing. The direction need not be a
  /// unit vector. Solids that contain the origin are not seen.
  std::optional<RayHit> intersect(const Eigen::Vector3d& origin_W,
                                  const Eigen::Vector3d& direction_W) const;

  /// Distance from p_W to the nearest surface of the union, metres. In free space it is positive
  /// and exact. Inside it is minus the largest of the depths of p_W in the solids that contain it;
  /// that is exact except near places where solids touch or overlap. Infinity for an empty scene.
  double signed_distance(const Eigen::Vector3d& p_W) const;

  /// The same, with the instance of the nearest solid. Of equally near solids it is the first in
  /// the list, as in intersect() and render().
  SurfaceDistance nearest_surface(const Eigen::Vector3d& p_W) const;

 private:
  std::vector<Primitive> primitives_;
  std::vector<Instance> instances_;
  Color light_;
  std::unique_ptr<Bvh> bvh_;
};

}  // namespace kintsugi::synthetic
