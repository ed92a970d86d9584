#pragma once
// A tree of bounding boxes over the solids of a scene.

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "mapper/synthetic/scene/shape.hpp"

namespace kintsugi::synthetic {

struct Primitive;

/// The bounding box in W of a solid.
Eigen::AlignedBox3d bounding_box_W(const Primitive& primitive);

/// Binary tree, split at the median of the boxes' centres along the longest axis.
class Bvh {
 public:
  explicit Bvh(const std::vector<Primitive>& primitives);

  /// Calls visit(primitive index, nearest so far) -> t for each solid whose box the ray meets
  /// before the nearest so far; visit returns the smaller of the two. Returns the nearest.
  template <typename Visit>
  double nearest_along_ray(const Eigen::Vector3d& origin_W, const Eigen::Vector3d& direction_W,
                           Visit visit) const;

  /// Calls visit(primitive index, smallest so far) -> distance for each solid whose box is nearer
  /// than the smallest so far or contains the point. Returns the smallest.
  template <typename Visit>
  double nearest_to_point(const Eigen::Vector3d& p_W, Visit visit) const;

 private:
  struct Node {
    Eigen::AlignedBox3d box;
    std::int32_t first = 0;  // leaf: of its primitives in order_; inner: the right child
    std::int32_t count = 0;  // of a leaf's primitives; 0: inner, whose left child is the next node
  };
  static constexpr int kLeafSize = 2;
  static constexpr int kMaxDepth = 64;

  void build(std::vector<Eigen::AlignedBox3d>& boxes, std::int32_t first, std::int32_t last);

  /// Depth-first walk, nearer child first. key(box) bounds what is inside from below.
  template <typename Key, typename Visit>
  double walk(Key key, Visit visit) const;

  std::vector<Node> nodes_;
  std::vector<std::int32_t> order_;
};

}  // namespace kintsugi::synthetic

#include "mapper/synthetic/scene/bvh_walk.hpp"
