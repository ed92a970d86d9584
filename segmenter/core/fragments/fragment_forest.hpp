#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

#include "lcmtypes/base/growing_array.hpp"
#include "segmenter/core/engine/engine.hpp"

namespace kintsugi::segmenter {

/// The state of the fragment step: disjoint sets of components. A set of fewer than `limit` points
/// is small.
///
/// Each set is named after one of its components, found by a point of it, the namer. When a small
/// set joins a large one, the name of the large one stays. When two small ones join, the name is
/// that of the component of the edge's first point (by PointId). So names depend on the points
/// alone.
class FragmentForest {
 public:
  /// `components` by point, kNoComponent for points that are gone; `limit` in points.
  FragmentForest(std::span<const ComponentId> components, std::int64_t limit)
      : components_(components), limit_(limit), sets_(components.size()) {
    for (PointIndex i = 0; i < components.size(); ++i) {
      if (components[i] == kNoComponent) continue;
      Set& set = sets_[components[i]];
      set.parent = components[i];
      if (set.num_points == 0) set.namer = i;
      ++set.num_points;
    }
  }

  /// The root of the set of `component`.
  ComponentId find(ComponentId component) {
    while (sets_[component].parent != component) {
      sets_[component].parent = sets_[sets_[component].parent].parent;
      component = sets_[component].parent;
    }
    return component;
  }
  ComponentId find_point(PointIndex point) { return find(components_[point]); }
  std::uint32_t num_points(ComponentId root) const { return sets_[root].num_points; }
  bool is_small(ComponentId root) const { return num_points(root) < limit_; }
  /// A point of the component that the set is named after.
  PointIndex namer(ComponentId root) const { return sets_[root].namer; }

  /// Joins the sets of two roots, at least one of which is small, by an edge whose first point is
  /// `first_point`.
  void join(ComponentId a, ComponentId b, PointIndex first_point) {
    const bool are_both_small = is_small(a) && is_small(b);
    if (sets_[a].num_points < sets_[b].num_points) std::swap(a, b);
    sets_[b].parent = a;
    sets_[a].num_points += sets_[b].num_points;
    if (are_both_small) sets_[a].namer = first_point;
  }

 private:
  struct Set {
    ComponentId parent = 0;
    PointIndex namer = 0;
    std::uint32_t num_points = 0;
  };

  std::span<const ComponentId> components_;
  std::int64_t limit_;
  GrowingArray<Set> sets_;
};

}  // namespace kintsugi::segmenter
