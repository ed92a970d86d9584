#include "segmenter/core/points/voxel_pairs.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include "segmenter/core/points/cell.hpp"

namespace kintsugi::segmenter {
namespace {

/// A point by its voxel.
struct Place {
  std::uint64_t voxel;
  std::uint32_t point;

  bool operator<(const Place& other) const {
    return std::tie(voxel, point) < std::tie(other.voxel, other.point);
  }
};

/// The lowest 21 bits of each coordinate: voxels of one patch are never 2^21 voxels apart.
std::uint64_t number_of(const Cell& voxel) {
  constexpr int kBits = 21;
  const auto low_bits = [](std::int32_t value) {
    return static_cast<std::uint64_t>(static_cast<std::uint32_t>(value) & ((1U << kBits) - 1));
  };
  return (low_bits(voxel.z) << (2 * kBits)) | (low_bits(voxel.y) << kBits) | low_bits(voxel.x);
}

Cell voxel_of(const CloudPoint& p, double voxel_m) {
  return {cell_coordinate(p.x, voxel_m), cell_coordinate(p.y, voxel_m),
          cell_coordinate(p.z, voxel_m)};
}

std::vector<Place> places_of(std::span<const CloudPoint> points_W, double voxel_m) {
  std::vector<Place> places(points_W.size());
  for (std::uint32_t i = 0; i < points_W.size(); ++i) {
    places[i] = {number_of(voxel_of(points_W[i], voxel_m)), i};
  }
  std::sort(places.begin(), places.end());
  return places;
}

/// The voxels behind the nearer face of its voxel along each axis, the nearest face first.
std::array<std::uint64_t, 3> voxels_beside(const CloudPoint& p, double voxel_m) {
  struct Neighbour {
    double distance;  // of its face, voxels
    Cell voxel;
  };
  std::array<Neighbour, 3> neighbours;
  const Cell voxel = voxel_of(p, voxel_m);
  const std::array<float, 3> p_W = {p.x, p.y, p.z};
  constexpr std::array<std::int32_t Cell::*, 3> kAxes = {&Cell::x, &Cell::y, &Cell::z};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double inside = p_W[axis] / voxel_m - std::floor(p_W[axis] / voxel_m);
    neighbours[axis] = {std::min(inside, 1.0 - inside), voxel};
    neighbours[axis].voxel.*kAxes[axis] += inside < 0.5 ? -1 : 1;
  }
  std::ranges::stable_sort(neighbours, {}, &Neighbour::distance);
  return {number_of(neighbours[0].voxel), number_of(neighbours[1].voxel),
          number_of(neighbours[2].voxel)};
}

/// Takes a point in the voxel out of `places`, which are ascending. False when there is none.
bool take(std::vector<Place>& places, std::vector<bool>& is_taken, std::uint64_t voxel,
          std::uint32_t& point) {
  const auto first = std::ranges::lower_bound(places, voxel, {}, &Place::voxel);
  for (auto place = first; place != places.end() && place->voxel == voxel; ++place) {
    const auto k = static_cast<std::size_t>(place - places.begin());
    if (is_taken[k]) continue;
    is_taken[k] = true;
    point = place->point;
    return true;
  }
  return false;
}

}  // namespace

std::vector<PointPair> pair_by_voxel(std::span<const CloudPoint> before_W,
                                     std::span<const CloudPoint> after_W, double voxel_m) {
  std::vector<PointPair> pairs;
  pairs.reserve(std::min(before_W.size(), after_W.size()));
  const std::vector<Place> before = places_of(before_W, voxel_m);
  const std::vector<Place> after = places_of(after_W, voxel_m);
  std::vector<Place> left_before;
  std::vector<Place> left_after;
  auto from = before.begin();
  for (const Place& to : after) {
    for (; from != before.end() && from->voxel < to.voxel; ++from) left_before.push_back(*from);
    if (from != before.end() && from->voxel == to.voxel) {
      pairs.push_back({(from++)->point, to.point});
    } else {
      left_after.push_back(to);
    }
  }
  left_before.insert(left_before.end(), from, before.end());

  std::vector<bool> is_taken(left_before.size());
  for (const Place& to : left_after) {
    for (const std::uint64_t voxel : voxels_beside(after_W[to.point], voxel_m)) {
      std::uint32_t point = 0;
      if (!take(left_before, is_taken, voxel, point)) continue;
      pairs.push_back({point, to.point});
      break;
    }
  }
  std::ranges::sort(pairs, {}, &PointPair::after);
  return pairs;
}

}  // namespace kintsugi::segmenter
