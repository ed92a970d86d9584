#pragma once
// A tree of bounding boxes (bounding volume hierarchy).

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

namespace kintsugi::synthetic {

/// Binary tree over boxes, split at the median of their centres along the longest axis.
class Bvh {
 public:
  explicit Bvh(const std::vector<Eigen::AlignedBox3d>& boxes_W);

  /// Calls visit(index of box, nearest t so far) -> t for each box that the ray meets before the
  /// nearest t so far; visit returns the smaller of the two. Returns the nearest.
  template <typename Visit>
  double nearest_along_ray(const Eigen::Vector3d& origin_W, const Eigen::Vector3d& direction_W,
                           Visit visit) const;

  /// Calls visit(index of box, smallest distance so far) -> distance for each box that is nearer
  /// than the smallest distance so far or contains the point. Returns the smallest.
  template <typename Visit>
  double nearest_to_point(const Eigen::Vector3d& p_W, Visit visit) const;

 private:
  struct Node {
    Eigen::AlignedBox3d box;
    std::int32_t first = 0;  // leaf: position of its first box in order_; inner: its right child
    std::int32_t count = 0;  // leaf: number of boxes; 0: inner, whose left child is the next node
  };
  static constexpr int kLeafSize = 2;
  static constexpr int kMaxDepth = 64;

  void build(const std::vector<Eigen::AlignedBox3d>& boxes, std::int32_t first, std::int32_t last);

  /// Depth-first walk, nearer child first. key(box) is a lower bound for what visit() returns for
  /// its contents.
  template <typename Key, typename Visit>
  double walk(Key key, Visit visit) const;

  std::vector<Node> nodes_;
  std::vector<std::int32_t> order_;
};

template <typename Key, typename Visit>
double Bvh::walk(Key key, Visit visit) const {
  double best = std::numeric_limits<double>::infinity();
  if (nodes_.empty()) return best;
  struct Pending {
    std::int32_t node;
    double key;
  };
  std::array<Pending, kMaxDepth> stack;  // NOLINT: filled from the bottom
  int size = 0;
  stack[size++] = {0, key(nodes_[0].box)};
  while (size > 0) {
    const Pending pending = stack[--size];
    // A box that holds the point (key zero) may hold a negative distance, so zero never prunes.
    if (pending.key > std::max(best, 0.0) || std::isinf(pending.key)) continue;
    const Node& node = nodes_[pending.node];
    if (node.count > 0) {
      for (std::int32_t i = 0; i < node.count; ++i) best = visit(order_[node.first + i], best);
      continue;
    }
    Pending nearer{pending.node + 1, key(nodes_[pending.node + 1].box)};
    Pending farther{node.first, key(nodes_[node.first].box)};
    if (farther.key < nearer.key) std::swap(nearer, farther);
    stack[size++] = farther;
    stack[size++] = nearer;
  }
  return best;
}

template <typename Visit>
double Bvh::nearest_along_ray(const Eigen::Vector3d& origin_W, const Eigen::Vector3d& direction_W,
                              Visit visit) const {
  const Eigen::Array3d inverse = direction_W.array().inverse();
  const auto entry = [&](const Eigen::AlignedBox3d& box) {
    const Eigen::Array3d low = (box.min() - origin_W).array() * inverse;
    const Eigen::Array3d high = (box.max() - origin_W).array() * inverse;
    const double enter = std::max(low.min(high).maxCoeff(), 0.0);
    const double leave = low.max(high).minCoeff();
    return enter <= leave ? enter : std::numeric_limits<double>::infinity();
  };
  return walk(entry, visit);
}

template <typename Visit>
double Bvh::nearest_to_point(const Eigen::Vector3d& p_W, Visit visit) const {
  return walk([&](const Eigen::AlignedBox3d& box) { return box.exteriorDistance(p_W); }, visit);
}

}  // namespace kintsugi::synthetic
