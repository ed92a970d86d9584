#include "mapper/synthetic/scene/bvh.hpp"

#include <numeric>

namespace kintsugi::synthetic {

Bvh::Bvh(const std::vector<Eigen::AlignedBox3d>& boxes_W) : order_(boxes_W.size()) {
  if (boxes_W.empty()) return;
  std::iota(order_.begin(), order_.end(), 0);
  build(boxes_W, 0, static_cast<std::int32_t>(boxes_W.size()));
}

void Bvh::build(const std::vector<Eigen::AlignedBox3d>& boxes, std::int32_t first,
                std::int32_t last) {
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
