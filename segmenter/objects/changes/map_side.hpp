#pragma once
// One of the two maps that are compared.

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "lcmtypes/messages.hpp"
#include "segmenter/objects/recognition/scene.hpp"
#include "segmenter/objects/recognition/surface.hpp"
#include "segmenter/preprocess/nearest_neighbours.hpp"
#include "segmenter/views/observed_space.hpp"

namespace kintsugi::segmenter {

/// So many points around a place tell what surface is there: of two that meet, some are on each.
inline constexpr int kNeighboursAround = 8;
/// Cosine between normals of one surface in two maps: 60 degrees, which they differ by at edges.
inline constexpr float kAlikeNormals = 0.5F;

/// All of it in the frame and the light of AFTER.
class MapSide {
 public:
  /// @param segment_ids of each point; must outlive this
  MapSide(std::vector<CloudPoint> points, std::span<const std::uint32_t> segment_ids,
          double voxel_m);
  /// What its cameras saw; before, nothing is known of it.
  void set_space(ObservedSpace space) { space_ = std::move(space); }

  [[nodiscard]] const std::vector<CloudPoint>& points() const { return points_; }
  [[nodiscard]] std::span<const std::uint32_t> segment_ids() const { return segment_ids_; }
  [[nodiscard]] const ObservedSpace& space() const { return space_; }
  /// Of each point the colour of its surroundings.
  [[nodiscard]] const Surface& colors() const { return colors_; }
  [[nodiscard]] const NearestNeighbours& tree() const { return tree_; }
  [[nodiscard]] double voxel_m() const { return voxel_m_; }

  /// Indices of the points of a segment, ascending; none: there is no such segment.
  [[nodiscard]] const std::vector<std::size_t>& points_of(std::uint32_t segment) const;
  [[nodiscard]] std::vector<CloudPoint> points_at(std::span<const std::size_t> indices) const;
  /// Indices of the points in a box.
  [[nodiscard]] std::vector<std::size_t> points_in(const Eigen::AlignedBox3f& box) const;
  /// The map as the recogniser sees it; valid as long as this.
  [[nodiscard]] std::unique_ptr<Scene> scene() const;

 private:
  using Cell = std::array<std::int32_t, 3>;

  std::vector<CloudPoint> points_;
  std::span<const std::uint32_t> segment_ids_;
  ObservedSpace space_;
  double voxel_m_;
  Surface colors_;
  NearestNeighbours tree_;
  std::map<std::uint32_t, std::vector<std::size_t>> by_segment_;
  std::map<Cell, std::vector<std::size_t>> by_cell_;
};

}  // namespace kintsugi::segmenter
