#pragma once
// What things of one make have in common: their name for it, their size and their symmetry.

#include <Eigen/Core>
#include <string>
#include <vector>

#include "mapper/synthetic/scene/scene.hpp"

namespace kintsugi::synthetic {

/// Name, word for the colour, and size along the axes of G in millimetres: "mug red 128x90x105".
/// In the scenes "office" and "kitchen" and what is made of them, things of the same model are
/// alike in every solid and material.
std::string model_of(const Instance& instance, const std::vector<Primitive>& primitives);

/// A turn that leaves the shape of a thing as it is.
struct SymmetryAxis {
  Eigen::Vector3d direction_G = Eigen::Vector3d::UnitZ();  ///< unit vector, through the centre
  int order = 2;  ///< by 360 degrees / order; kAnyAngle: by any angle
};
inline constexpr int kAnyAngle = 0;

/// The rotations about the axes of G, through `centre_G`, that leave the shape as it is, and those
/// that follow from them. Of the appearance only the plain colours of the solids count.
struct Symmetry {
  Eigen::Vector3d centre_G = Eigen::Vector3d::Zero();  ///< of the bounding box in G, metres
  std::vector<SymmetryAxis> axes;                      ///< x, y, z of G; none: no symmetry
};

Symmetry symmetry_of(const Instance& instance, const std::vector<Primitive>& primitives);

}  // namespace kintsugi::synthetic
