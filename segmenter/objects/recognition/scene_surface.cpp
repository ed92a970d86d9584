#include "segmenter/objects/recognition/scene_surface.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "segmenter/objects/recognition/agreement.hpp"

namespace kintsugi::segmenter {

void SceneSurface::set_gain(const Eigen::Array3f& gain) {
  gain_ = gain;
  blocks_.clear();
}

void SceneSurface::forget(const std::set<BlockKey>& blocks) {
  // The colours of a point are means that reach into the blocks around its own.
  for (const BlockKey& key : blocks) {
    for (std::int32_t z = key[2] - 1; z <= key[2] + 1; ++z) {
      for (std::int32_t y = key[1] - 1; y <= key[1] + 1; ++y) {
        for (std::int32_t x = key[0] - 1; x <= key[0] + 1; ++x) {
          blocks_.unsafe_erase({x, y, z});
        }
      }
    }
  }
}

const SceneSurface::Block* SceneSurface::block(const BlockKey& key) const {
  const auto at = blocks_.find(key);
  if (at != blocks_.end()) return &at->second;
  if (map_.points_in(key).empty()) return nullptr;
  return &blocks_.emplace(key, made(key)).first->second;
}

SceneSurface::Block SceneSurface::made(const BlockKey& key) const {
  const Eigen::Vector3f low_W =
      Eigen::Vector3f(static_cast<float>(key[0]), static_cast<float>(key[1]),
                      static_cast<float>(key[2])) *
      map_.block_m();
  const Eigen::Vector3f margin = Eigen::Vector3f::Constant(color_radius_m(resolution_m_));
  const Eigen::Vector3f high_W = low_W.array() + map_.block_m();
  const Eigen::AlignedBox3f box_W(low_W - margin, high_W + margin);
  std::vector<LabelledMap::PointRef> refs;
  std::vector<CloudPoint> points_W;
  const auto add = [&](const BlockKey& from) {
    for (const LabelledMap::PointRef& ref : map_.points_in(from)) {
      const CloudPoint& point = map_.point_W(ref);
      if (from == key) {
        refs.push_back(ref);
      } else if (box_W.contains(Eigen::Vector3f(point.x, point.y, point.z))) {
        points_W.push_back(point);
      }
    }
  };
  add(key);
  points_W.reserve(refs.size());
  for (const LabelledMap::PointRef& ref : refs) points_W.push_back(map_.point_W(ref));
  for (std::int32_t z = key[2] - 1; z <= key[2] + 1; ++z) {
    for (std::int32_t y = key[1] - 1; y <= key[1] + 1; ++y) {
      for (std::int32_t x = key[0] - 1; x <= key[0] + 1; ++x) {
        if (const BlockKey other{x, y, z}; other != key) add(other);
      }
    }
  }
  Surface surface_W = unthinned(points_W, resolution_m_);
  surface_W.resize(refs.size());
  relight(surface_W, gain_);
  return {std::move(refs), SurfaceGrid(std::move(surface_W), kSameDistance * resolution_m_)};
}

}  // namespace kintsugi::segmenter
