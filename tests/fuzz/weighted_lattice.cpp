#include "tests/fuzz/weighted_lattice.hpp"

#include <cassert>
#include <cmath>
#include <cstdlib>

namespace kintsugi::segmenter::fuzz {
namespace {

constexpr double kSpacing_m = 0.015;

}  // namespace

WeightedLattice::WeightedLattice(Site site) { add_point(site, 1.0); }

PoolIndex WeightedLattice::add(Site site, PoolIndex neighbour, double weight) {
  assert(std::abs(site.x - sites_[neighbour].x) + std::abs(site.y - sites_[neighbour].y) == 1);
  return add_point(site, (1.0 - weight) / points_[neighbour].nz);
}

PoolIndex WeightedLattice::add_row(PoolIndex first, Site direction,
                                   std::span<const double> weights) {
  for (const double weight : weights) {
    const Site site = {sites_[first].x + direction.x, sites_[first].y + direction.y};
    first = add(site, first, weight);
  }
  return first;
}

PoolIndex WeightedLattice::add_point(Site site, double length) {
  assert(std::abs(length - 1.0) < 0.01);  // more, and the cloud would not admit the normal
  const bool is_free = taken_.emplace(site.x, site.y).second;
  assert(is_free);
  static_cast<void>(is_free);
  sites_.push_back(site);
  points_.push_back({.x = static_cast<float>(kSpacing_m * site.x),
                     .y = static_cast<float>(kSpacing_m * site.y),
                     .nz = static_cast<float>(length),
                     .weight = 1.0F});
  return size() - 1;
}

std::vector<CloudPoint> chain_of_weights(std::span<const double> weights) {
  WeightedLattice lattice;
  lattice.add_row(0, {1, 0}, weights);
  return lattice.points();
}

}  // namespace kintsugi::segmenter::fuzz
