#include "segmenter/core/exact/component_names.hpp"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <tuple>
#include <utility>

#include <oneapi/tbb/parallel_for.h>

namespace kintsugi::segmenter::exact {
namespace {

// While names are given, the scratch field holds the vertex's position in the list of roots or
// touched vertices.
std::uint32_t& position(Vertex& v) { return v.visit; }

}  // namespace

void ComponentNames::update(std::vector<PointIndex>& touched, std::span<const PointIndex> removed) {
  changed_.clear();
  names_.resize(vertices_.size(), kNoComponent);
  std::erase_if(touched, [&](PointIndex x) { return vertices_[x].is_gone != 0; });
  // The root counts when its component is named, even if only other vertices in it were touched.
  for (std::size_t k = 0; k < touched.size(); ++k) {
    const PointIndex root = forest_.root(touched[k]);
    if (!vertices_[root].is_touched) touched.push_back(root);
    vertices_[root].is_touched = 1;
    position(vertices_[touched[k]]) = static_cast<std::uint32_t>(k);
  }
  const std::vector<ComponentId> new_names = give_names(count_pieces(touched), touched, removed);
  for (const PointIndex x : touched) {
    const ComponentId name = new_names[position(vertices_[forest_.root(x)])];
    if (names_[x] != name) relabel_piece(x, name);
  }
  for (const PointIndex x : touched) {
    vertices_[x].is_touched = 0;
    position(vertices_[x]) = 0;
  }
  for (const PointIndex x : removed) vertices_[x].is_touched = 0;
  std::sort(changed_.begin(), changed_.end());
}

void ComponentNames::update_all(std::span<const PointIndex> removed) {
  changed_.clear();
  names_.resize(vertices_.size(), kNoComponent);
  std::vector<PointIndex> roots;
  for (PointIndex x = 0; x < vertices_.size(); ++x) {
    if (!is_live_root(x)) continue;
    position(vertices_[x]) = static_cast<std::uint32_t>(roots.size());
    roots.push_back(x);
  }
  const std::vector<std::uint32_t> components = find_components();
  std::vector<Share> shares;
  for (PointIndex x = 0; x < vertices_.size(); ++x) {
    if (components[x] == kNone) continue;
    if (shares.empty() || shares.back().component != components[x] ||
        shares.back().old_name != names_[x]) {
      shares.push_back({components[x], names_[x], 0});
    }
    ++shares.back().num_points;
  }
  const std::vector<ComponentId> new_names = give_names(std::move(shares), roots, removed);
  for (PointIndex x = 0; x < vertices_.size(); ++x) {
    if (components[x] != kNone) set_name(x, new_names[components[x]]);
  }
  for (const PointIndex root : roots) position(vertices_[root]) = 0;
}

/// A point that is gone is a root, too, with no guest. Only records of roots are read: those of all
/// vertices are the largest part of the engine's memory.
bool ComponentNames::is_live_root(PointIndex x) const {
  return vertices_.is_root(x) && vertices_[x].is_gone == 0;
}

/// By point: the position of its root; kNone for points that are gone.
std::vector<std::uint32_t> ComponentNames::find_components() const {
  std::vector<std::uint32_t> components(vertices_.size(), kNone);
  oneapi::tbb::parallel_for(std::size_t{0}, components.size(), [&](std::size_t i) {
    const PointIndex root = forest_.root(static_cast<PointIndex>(i));
    if (vertices_[root].is_gone == 0) components[i] = vertices_[root].visit;
  });
  return components;
}

/// A piece is a touched vertex and everything below it down to the next touched ones. The hosts
/// inside it did not change, so all its points had one name.
std::vector<ComponentNames::Share> ComponentNames::count_pieces(
    std::span<const PointIndex> touched) const {
  std::vector<Share> shares(touched.size());
  for (std::size_t k = 0; k < touched.size(); ++k) {
    const PointIndex x = touched[k];
    const std::uint32_t total = forest_.history().total(x);
    shares[k].component = vertices_[forest_.root(x)].visit;
    shares[k].old_name = names_[x];
    shares[k].num_points += total;
    if (vertices_.is_root(x)) continue;
    PointIndex above = vertices_.host(x);
    while (!vertices_[above].is_touched) above = vertices_.host(above);
    shares[vertices_[above].visit].num_points -= total;
  }
  return shares;
}

/// The new name of each component that has a share, by its position in `roots`: the name that most
/// of its points had, if no other component has more points of that name; else a free one.
std::vector<ComponentId> ComponentNames::give_names(std::vector<Share> shares,
                                                    std::span<const PointIndex> roots,
                                                    std::span<const PointIndex> removed) {
  std::sort(shares.begin(), shares.end(), [](const Share& x, const Share& y) {
    return std::tie(x.component, x.old_name) < std::tie(y.component, y.old_name);
  });
  std::vector<Share> claims;  // one for each component
  for (auto first = shares.begin(); first != shares.end();) {
    Share sum = *first;
    for (++first; first != shares.end() && first->component == sum.component &&
                  first->old_name == sum.old_name;
         ++first) {
      sum.num_points += first->num_points;
    }
    if (claims.empty() || claims.back().component != sum.component) {
      claims.push_back(sum);
    } else if (sum.old_name != kNoComponent && sum.num_points > claims.back().num_points) {
      claims.back() = sum;
    }
  }
  std::sort(claims.begin(), claims.end(), [](const Share& x, const Share& y) {
    return std::tuple(x.old_name, y.num_points, x.component) <
           std::tuple(y.old_name, x.num_points, y.component);
  });

  std::vector<ComponentId> new_names(roots.size(), kNoComponent);
  std::vector<ComponentId> kept;
  for (const Share& claim : claims) {
    if (claim.old_name == kNoComponent) break;
    if (!kept.empty() && kept.back() == claim.old_name) continue;
    kept.push_back(claim.old_name);
    new_names[claim.component] = claim.old_name;
  }
  release_names(shares, removed, kept);
  for (const Share& claim : claims) {
    ComponentId& name = new_names[claim.component];
    if (name == kNoComponent) {
      if (free_.empty()) {
        free_.push_back(static_cast<ComponentId>(roots_.size()));
        roots_.push_back(kNone);
      }
      name = free_.back();
      free_.pop_back();
    }
    roots_[name] = roots[claim.component];
  }
  return new_names;
}

/// Frees the names that touched or removed points had and no component keeps.
void ComponentNames::release_names(std::span<const Share> shares,
                                   std::span<const PointIndex> removed,
                                   const std::vector<ComponentId>& kept) {
  std::vector<ComponentId> old_names;
  for (const Share& share : shares) old_names.push_back(share.old_name);
  for (const PointIndex x : removed) old_names.push_back(std::exchange(names_[x], kNoComponent));
  std::sort(old_names.begin(), old_names.end());
  old_names.erase(std::unique(old_names.begin(), old_names.end()), old_names.end());
  if (!old_names.empty() && old_names.back() == kNoComponent) old_names.pop_back();
  std::set_difference(old_names.begin(), old_names.end(), kept.begin(), kept.end(),
                      std::back_inserter(free_));
}

void ComponentNames::relabel_piece(PointIndex top, ComponentId name) {
  std::vector<PointIndex> stack{top};
  while (!stack.empty()) {
    const PointIndex x = stack.back();
    stack.pop_back();
    set_name(x, name);
    forest_.history().for_each_guest(x, [&](PointIndex guest) {
      if (!vertices_[guest].is_touched) stack.push_back(guest);
    });
  }
}

void ComponentNames::set_name(PointIndex x, ComponentId name) {
  if (names_[x] == name) return;
  names_[x] = name;
  changed_.push_back(x);
}

}  // namespace kintsugi::segmenter::exact
