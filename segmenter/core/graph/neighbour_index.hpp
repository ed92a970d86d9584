#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string_view>

#include "segmenter/core/points/point_cloud.hpp"
#include "segmenter/core/points/point_rows.hpp"

namespace kintsugi::segmenter {

/// The kinds of index that make_neighbour_index() makes.
enum class NeighbourSearch { kGrid, kFlann };

/// The name in options and files.
constexpr std::string_view name_of(NeighbourSearch search) {
  return search == NeighbourSearch::kGrid ? "grid" : "flann";
}

/// ||a - b||^2 in float32, summed as (dx^2 + dy^2) + dz^2. The order is part of the definition of
/// the graph: every build and every index decides on this very number.
inline float squared_distance(const CloudPoint& a, const CloudPoint& b) {
  const float dx = a.x - b.x;
  const float dy = a.y - b.y;
  const float dz = a.z - b.z;
  return (dx * dx + dy * dy) + dz * dz;
}

/// Whether a and b are neighbours (Algorithm 2, line 3): closer than r, strictly.
inline bool are_neighbours(const CloudPoint& a, const CloudPoint& b, float radius_m) {
  return squared_distance(a, b) < radius_m * radius_m;
}

/// Finds the neighbours of points among those that were inserted and not removed. All
/// implementations find the same ones.
class NeighbourIndex {
 public:
  /// A point and its neighbours, without itself, in no particular order.
  using Visit = std::function<void(PointIndex point, std::span<const PointIndex> neighbours)>;

  virtual ~NeighbourIndex() = default;

  /// Adds points of the cloud that are not in the index.
  virtual void insert(std::span<const PointIndex> points) = 0;
  /// Removes points. The cloud must still hold their positions.
  virtual void remove(std::span<const PointIndex> points) = 0;
  /// Removes all points, wherever they are now, and adds those of `rows`, which were made for the
  /// same radius.
  virtual void assign(const PointRows& rows) = 0;

  /// Visits `points`, which must be in the index, in this order and in the calling thread.
  virtual void visit(std::span<const PointIndex> points, const Visit& visit_point) const = 0;
  /// As visit(), for places that need not be points of the cloud. `point` of Visit is then the
  /// position in `places_W`.
  virtual void visit_places(std::span<const CloudPoint> places_W,
                            const Visit& visit_place) const = 0;
  /// As visit(), in any order and from several threads at once.
  virtual void visit_concurrently(std::span<const PointIndex> points,
                                  const Visit& visit_point) const = 0;
  /// Visits every point in the index once, in any order and from several threads at once.
  virtual void visit_all(const Visit& visit_point) const = 0;

  /// What is not used for long may go to disk from now on.
  virtual void swap_to(SwapSpace& /*space*/) {}

  /// Memory taken, without the overhead of the allocator.
  virtual std::size_t bytes() const = 0;
};

}  // namespace kintsugi::segmenter
