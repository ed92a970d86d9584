#include "viewer/core/map/point_chunk.hpp"

#include <algorithm>

namespace kintsugi::viewer {

std::vector<Eigen::AlignedBox3f> chunk_boxes_of(std::span<const CloudPoint> points_W) {
  std::vector<Eigen::AlignedBox3f> boxes_W;
  for (std::size_t first = 0; first < points_W.size(); first += PointChunk::kMaxPoints) {
    Eigen::AlignedBox3f box_W;
    const std::size_t count = std::min(PointChunk::kMaxPoints, points_W.size() - first);
    for (const CloudPoint& p : points_W.subspan(first, count)) {
      const Eigen::Vector3f p_W(p.x, p.y, p.z);
      if (p_W.allFinite()) box_W.extend(p_W);
    }
    boxes_W.push_back(box_W);
  }
  return boxes_W;
}

}  // namespace kintsugi::viewer
