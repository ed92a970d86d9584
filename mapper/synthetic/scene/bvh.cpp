#include "mapper/synthetic/scene/bvh.hpp"

#include <numeric>

#include "mapper/synthetic/scene/scene.hpp"

namespace kintsugi::synthetic {

Eigen::AlignedBox3d bounding_box_W(const Primitive& primitive) {
  // A rotated box reaches |R| h along each axis. The margin covers rays that run along a face.
  constexpr double kMargin = 1e-6;
  const Eigen::Vector3d reach =
      (primitive.X_WO.linear().cwiseAbs() * primitive.shape.half_extents).array() + kMargin;
  const Eigen::Vector3d centre = primitive.X_WO.translation();
  return {centre - reach, centre + reach};
}

Bvh::Bvh(const std::vector<Primitive>& primitives) : order_(primitives.size()) {
  if (primitives.empty()) return;
  std::vector<Eigen::AlignedBox3d> boxes;
  boxes.reserve(primitives.size());
  for (const Primitive& primitive : primitives) boxes.push_back(bounding_box_W(primitive));
  std::iota(order_.begin(), order_.end(), 0);
  build(boxes, 0, static_cast<std::int32_t>(primitives.size()));
}

void Bvh::build(std::vector<Eigen::AlignedBox3d>& boxes, std::int32_t first, std::int32_t last) {
  const std::size_t index = nodes_.size();
  nodes_.emplace_back();
  for (std::int32_t i = first; i < last; ++i) nodes_[index].box.extend(boxes[order_[i]]);
  if (last - first <= kLeafSize) {
    nodes_[index].first = first;
    nodes_[index].count = last - first;
    return;
  }
  Eigen::AlignedBox3d centres;
  for (std::int32_t i = first; i < last; ++i) centres.extend(boxes[order_[i]].center());
  int axis = 0;
  centres.sizes().maxCoeff(&axis);
  const std::int32_t middle = first + (last - first) / 2;
  std::nth_element(order_.begin() + first, order_.begin() + middle, order_.begin() + last,
                   [&](std::int32_t a, std::int32_t b) {
                     const double ca = boxes[a].center()[axis];
                     const double cb = boxes[b].center()[axis];
                     return ca != cb ? ca < cb : a < b;
                   });
  build(boxes, first, middle);
  nodes_[index].first = static_cast<std::int32_t>(nodes_.size());
  build(boxes, middle, last);
}

}  // namespace kintsugi::synthetic
