#pragma once

#include <memory>
#include <span>
#include <unordered_map>
#include <vector>

#include "segmenter/core/graph/neighbour_index.hpp"
#include "segmenter/core/points/cell.hpp"

namespace kintsugi::segmenter {

/// Neighbours by FLANN, with a kd-tree for each cubic tile of 1 m. FLANN's single kd-tree hardly
/// supports changes, so the trees of the tiles that a change touches are built again.
class FlannIndex final : public NeighbourIndex {
 public:
  FlannIndex(const PointCloud& cloud, float radius_m);
  ~FlannIndex() override;

  void insert(std::span<const PointIndex> points) override;
  void remove(std::span<const PointIndex> points) override;
  void assign(const PointRows& rows) override;
  void visit(std::span<const PointIndex> points, const Visit& visit_point) const override;
  void visit_places(std::span<const CloudPoint> places_W, const Visit& visit_place) const override;
  void visit_concurrently(std::span<const PointIndex> points,
                          const Visit& visit_point) const override;
  void visit_all(const Visit& visit_point) const override;
  std::size_t bytes() const override;

 private:
  struct Tile;

  std::unique_ptr<Tile>& tile_at(PointIndex point);
  void build(std::span<Tile* const> tiles) const;
  void find_neighbours(const CloudPoint& place_W, PointIndex left_out,
                       std::vector<PointIndex>& neighbours) const;

  const PointCloud& cloud_;
  float radius_m_;
  std::unordered_map<Cell, std::unique_ptr<Tile>, CellHash> tiles_;
};

}  // namespace kintsugi::segmenter
