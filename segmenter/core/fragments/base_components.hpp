#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "lcmtypes/base/growing_array.hpp"
#include "segmenter/core/engine/engine.hpp"

namespace kintsugi::segmenter {

/// The partition below the fragment layer as it was when the layer last looked, with the sizes of
/// its components.
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

  /// Moves a point to another component; kNoComponent: it came, or goes. The point is smaller than
  /// what grow() was told.
  void set(PointIndex point, ComponentId name) {
    if (names_[point] != kNoComponent) --sizes_[names_[point]];
    names_[point] = name;
    if (name == kNoComponent) return;
    if (name >= sizes_.size()) sizes_.resize(name + std::size_t{1});
    ++sizes_[name];
  }

  std::size_t bytes() const { return names_.bytes() + sizes_.bytes(); }

 private:
  std::int64_t limit_;
  GrowingArray<ComponentId> names_;    ///< of points
  GrowingArray<std::uint32_t> sizes_;  ///< by name; 0: there is no such component
};

}  // namespace kintsugi::segmenter
