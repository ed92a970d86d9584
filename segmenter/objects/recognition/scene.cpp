#include "segmenter/objects/recognition/scene.hpp"

#include <utility>

#include "segmenter/objects/recognition/described_surface.hpp"

namespace kintsugi::segmenter {

namespace {

// A block is about as large as a cup, so that what is around an object is in some tens of them.
constexpr float kBlock_vox = 16.0F;
constexpr float kNeighbourRadius_vox = 2.0F;

}  // namespace

Scene::Scene(float resolution_m)
    : resolution_m_(resolution_m),
      map_(kBlock_vox * resolution_m),
      surface_(map_, resolution_m),
      borders_(map_, kNeighbourRadius_vox * resolution_m) {}

std::set<std::uint32_t> Scene::set_piece(std::int32_t id, LabelledMap::Points points_W,
                                         std::vector<std::uint32_t> segment_ids) {
  LabelledMap::Change change = map_.set_piece(id, std::move(points_W), std::move(segment_ids));
  surface_.forget(change.blocks);
  borders_.forget(change);
  for (const std::uint32_t segment : change.segments) {
    segments_.unsafe_erase(segment);
    rough_moments_.unsafe_erase(segment);
    shapes_.unsafe_erase(segment);
  }
  return std::move(change.segments);
}

Eigen::Vector3d Scene::up_W() const {
  const std::lock_guard lock(up_mutex_);
  return map_.up_W();
}

void Scene::set_light(const LightChange& light) {
  if (light.log_gain == light_.log_gain) return;
  light_ = light;
  surface_.set_gain((-light.log_gain.array()).exp());
  segments_.clear();
  rough_moments_.clear();
}

const Scene::SegmentSurface& Scene::segment(std::uint32_t id) const {
  const auto known = segments_.find(id);
  if (known != segments_.end()) return known->second;
  SegmentSurface segment;
  segment.surface_W = thinned(map_.points_of(id), resolution_m_);
  relight(segment.surface_W, (-light_.log_gain.array()).exp());
  segment.described_W = thinned(segment.surface_W, described_spacing_m(resolution_m_));
  segment.moments = SurfaceMoments(segment.described_W);
  return segments_.emplace(id, std::move(segment)).first->second;
}

const SurfaceMoments& Scene::rough_moments_of(std::uint32_t id) const {
  const auto known = rough_moments_.find(id);
  if (known != rough_moments_.end()) return known->second;
  Surface surface_W = roughly_thinned(map_.points_of(id), described_spacing_m(resolution_m_));
  relight(surface_W, (-light_.log_gain.array()).exp());
  return rough_moments_.emplace(id, SurfaceMoments(surface_W)).first->second;
}

const ShapeFeature& Scene::shape_of(std::uint32_t id) const {
  const auto known = shapes_.find(id);
  if (known != shapes_.end()) return known->second;
  const DescribedSurface described(segment(id).described_W, described_spacing_m(resolution_m_));
  return shapes_.emplace(id, described.features.rowwise().mean()).first->second;
}

Surface Scene::surface_W(std::span<const std::uint32_t> segments) const {
  Surface all;
  for (const std::uint32_t id : segments) {
    const Surface& surface = segment(id).surface_W;
    all.insert(all.end(), surface.begin(), surface.end());
  }
  return all;
}

SurfaceMoments Scene::moments(std::span<const std::uint32_t> segments) const {
  SurfaceMoments sum;
  for (const std::uint32_t id : segments) sum += segment(id).moments;
  return sum;
}

SurfaceMoments Scene::rough_moments(std::span<const std::uint32_t> segments) const {
  SurfaceMoments sum;
  for (const std::uint32_t id : segments) sum += rough_moments_of(id);
  return sum;
}

ShapeFeature Scene::shape(std::span<const std::uint32_t> segments) const {
  ShapeFeature sum = ShapeFeature::Zero();
  float count = 0.0F;
  for (const std::uint32_t id : segments) {
    const Surface& described_W = segment(id).described_W;
    if (described_W.empty()) continue;
    const auto points = static_cast<float>(described_W.size());
    sum += points * shape_of(id);
    count += points;
  }
  return count > 0.0F ? ShapeFeature(sum / count) : sum;
}

}  // namespace kintsugi::segmenter
