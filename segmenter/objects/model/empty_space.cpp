#include "segmenter/objects/model/empty_space.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <utility>

namespace kintsugi::segmenter {
namespace {

// Of the longest side: what stands out of an object farther is no part of it.
constexpr float kMargin = 0.25F;

/// The middle of a cell and places near its corners, from its lowest corner, in cells: not the
/// corners, which are in its neighbours too.
constexpr float kNear = 0.05F;
constexpr float kFar = 1 - kNear;
constexpr std::array<std::array<float, 3>, 9> kProbes = {{{0.5F, 0.5F, 0.5F},
                                                          {kNear, kNear, kNear},
                                                          {kNear, kNear, kFar},
                                                          {kNear, kFar, kNear},
                                                          {kNear, kFar, kFar},
                                                          {kFar, kNear, kNear},
                                                          {kFar, kNear, kFar},
                                                          {kFar, kFar, kNear},
                                                          {kFar, kFar, kFar}}};

struct Grid {
  Eigen::Vector3f low_O = Eigen::Vector3f::Zero();
  float cell_m = 0.0F;
  Eigen::Vector3i size = Eigen::Vector3i::Zero();

  [[nodiscard]] std::size_t num_cells() const { return static_cast<std::size_t>(size.prod()); }
  [[nodiscard]] Eigen::Vector3f corner(std::size_t cell) const {
    const auto i = static_cast<int>(cell);
    const Eigen::Vector3i at(i % size.x(), i / size.x() % size.y(), i / (size.x() * size.y()));
    return low_O + at.cast<float>() * cell_m;
  }
};

Grid grid_around(std::span<const CloudPoint> points_O) {
  Eigen::AlignedBox3f box_O;
  for (const CloudPoint& p : points_O) box_O.extend(Eigen::Vector3f(p.x, p.y, p.z));
  const float longest_m = box_O.sizes().maxCoeff();
  const Eigen::Vector3f margin = Eigen::Vector3f::Constant(kMargin * longest_m);
  Grid grid;
  grid.low_O = box_O.min() - margin;
  grid.cell_m = (1 + 2 * kMargin) * longest_m / EmptySpace::kMostCells;
  if (!(grid.cell_m > 0.0F)) return {};  // a single point
  const Eigen::Vector3f sides = box_O.sizes() + 2 * margin;
  grid.size = (sides / grid.cell_m).array().ceil().cast<int>().max(1).min(EmptySpace::kMostCells);
  return grid;
}

}  // namespace

EmptySpace::EmptySpace(const Eigen::Vector3f& low_O, float cell_m, const Eigen::Vector3i& size,
                       std::vector<bool> is_empty)
    : low_O_(low_O), cell_m_(cell_m), size_(size), is_empty_(std::move(is_empty)) {
  const bool has_size = (size.array() >= 1).all() && (size.array() <= kMostCells).all();
  if (!has_size || !(cell_m > 0.0F) || !low_O.allFinite() ||
      is_empty_.size() != static_cast<std::size_t>(size.prod())) {
    throw std::invalid_argument("a grid of empty space needs 1 to " + std::to_string(kMostCells) +
                                " cells along each axis, and a value for each");
  }
  is_unknown_ = std::find(is_empty_.begin(), is_empty_.end(), true) == is_empty_.end();
}

bool EmptySpace::contains(const Eigen::Vector3f& p_O) const {
  if (is_empty_.empty()) return false;
  const Eigen::Vector3f cell = (p_O - low_O_) / cell_m_;
  // Written so that NaN is outside.
  if (!(cell.minCoeff() >= 0.0F && (cell.array() < size_.cast<float>().array()).all())) {
    return false;
  }
  const Eigen::Vector3i at = cell.cast<int>();
  const int index = (at.z() * size_.y() + at.y()) * size_.x() + at.x();
  return is_empty_[static_cast<std::size_t>(index)];
}

EmptySpace empty_space(std::span<const CloudPoint> points_O, const Pose& X_WO,
                       const ObservedSpace& observed) {
  const Grid grid = grid_around(points_O);
  if (observed.empty() || grid.num_cells() == 0) return {};
  std::vector<Eigen::Vector3f> probes_W;
  probes_W.reserve(grid.num_cells() * kProbes.size());
  const Eigen::Isometry3f X = X_WO.cast<float>();
  for (std::size_t cell = 0; cell < grid.num_cells(); ++cell) {
    for (const std::array<float, 3>& probe : kProbes) {
      const Eigen::Vector3f offset(probe[0], probe[1], probe[2]);
      probes_W.emplace_back(X * (grid.corner(cell) + offset * grid.cell_m));
    }
  }
  const std::vector<Sights> sights = observed.sights(probes_W);
  std::vector<bool> is_empty(grid.num_cells());
  for (std::size_t cell = 0; cell < is_empty.size(); ++cell) {
    const auto first = sights.begin() + static_cast<std::ptrdiff_t>(cell * kProbes.size());
    is_empty[cell] = std::all_of(first, first + kProbes.size(), [](const Sights& probe) {
      return probe.through > probe.measured;
    });
  }
  return {grid.low_O, grid.cell_m, grid.size, std::move(is_empty)};
}

EmptySpace merged(std::span<const CloudPoint> points_O, const EmptySpace& known,
                  const EmptySpace& lesson, const Pose& X_OL) {
  const Grid grid = grid_around(points_O);
  if ((known.is_unknown() && lesson.is_unknown()) || grid.num_cells() == 0) return {};
  const Eigen::Isometry3f X_LO = X_OL.inverse().cast<float>();
  std::vector<bool> is_empty(grid.num_cells());
  for (std::size_t cell = 0; cell < is_empty.size(); ++cell) {
    is_empty[cell] = std::ranges::all_of(kProbes, [&](const std::array<float, 3>& probe) {
      const Eigen::Vector3f p_O =
          grid.corner(cell) + Eigen::Vector3f(probe[0], probe[1], probe[2]) * grid.cell_m;
      return known.contains(p_O) || lesson.contains(X_LO * p_O);
    });
  }
  return {grid.low_O, grid.cell_m, grid.size, std::move(is_empty)};
}

}  // namespace kintsugi::segmenter
