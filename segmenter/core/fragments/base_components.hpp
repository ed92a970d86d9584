#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "lcmtypes/base/growing_array.hpp"
#include "segmenter/core/engine/engine.hpp"

namespace kintsugi::segmenter {

/// The partition of the engine below the fragment layer, as of the layer's last update, with the
/// sizes of its components.
class BaseComponents {
 public:
  /// Components of fewer than `limit` points are fragments.
  explicit BaseComponents(std::int64_t limit) : limit_(limit) {}

  /// kNoComponent for points that are not in the cloud.
  ComponentId operator[](PointIndex point) const { return names_[point]; }
  std::uint32_t num_points(ComponentId name) const { return sizes_[name]; }
  bool is_fragment(ComponentId name) const { return sizes_[name] < limit_; }
  bool is_in_fragment(PointIndex point) const {
    return names_[point] != kNoComponent && is_fragment(names_[point]);
  }
  std::int64_t limit() const { return limit_; }
  std::span<const ComponentId> of_points() const { return names_.span(); }

  void grow(PointIndex num_points) { names_.resize(num_points, kNoComponent); }

  /// Moves a point, which is below the size given to grow(), to the component `name`; kNoComponent:
  /// the point is gone.
  void set(PointIndex point, ComponentId name) {
    if (names_[point] != kNoComponent) --sizes_[names_[point]];
    names_[point] = name;
    if (name == kNoComponent) return;
    if (name >= sizes_.size()) sizes_.resize(name + std::size_t{1});
    ++sizes_[name];
  }

  void swap_to(SwapSpace& space) {
    names_.swap_to(space);
    sizes_.swap_to(space);
  }
  std::size_t bytes() const { return names_.bytes() + sizes_.bytes(); }

 private:
  std::int64_t limit_;
  GrowingArray<ComponentId> names_;    ///< by point
  GrowingArray<std::uint32_t> sizes_;  ///< in points, by name; 0: there is no such component
};

}  // namespace kintsugi::segmenter
