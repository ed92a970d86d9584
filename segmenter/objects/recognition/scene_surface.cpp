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
  for (const BlockKey& changed : blocks) {
    for_each_around(changed, [this](const BlockKey& key) { blocks_.unsafe_erase(key); });
  }
}

const SceneSurface::Block* SceneSurface::block(const BlockKey& key) const {
  const auto at = blocks_.find(key);
  if (at != blocks_.end()) return &at->second;
  if (!map_.has_points_in(key)) return nullptr;
  return &blocks_.emplace(key, made(key)).first->second;
}

SceneSurface::Block SceneSurface::made(const BlockKey& key) const {
  const Eigen::AlignedBox3f box_W = map_.box_of(key, color_radius_m(resolution_m_));
  std::vector<LabelledMap::PointRef> refs;
  std::vector<CloudPoint> points_W;
  map_.visit_points_in(key, [&](LabelledMap::PointRef ref, const CloudPoint& point_W, auto) {
    refs.push_back(ref);
    points_W.push_back(point_W);
  });
  for_each_around(key, [&](const BlockKey& other) {
    if (other == key) return;
    map_.visit_points_in(other, [&](LabelledMap::PointRef, const CloudPoint& point_W, auto) {
      if (!box_W.contains(Eigen::Vector3f(point_W.x, point_W.y, point_W.z))) return;
      points_W.push_back(point_W);
    });
  });
  Surface surface_W = unthinned(points_W, resolution_m_);
  surface_W.resize(refs.size());
  relight(surface_W, gain_);
  return {std::move(refs), SurfaceGrid(std::move(surface_W), kSameDistance * resolution_m_)};
}

}  // namespace kintsugi::segmenter
