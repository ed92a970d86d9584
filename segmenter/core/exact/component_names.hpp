#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "segmenter/core/engine/engine.hpp"
#include "segmenter/core/exact/join_forest.hpp"
#include "segmenter/core/exact/vertex.hpp"

namespace kintsugi::segmenter::exact {

/// Names the components so that few points change name: a component keeps the name that most of
/// its points had, and only the points that were in another component before are relabelled. So the
/// time of an update is proportional to the touched vertices and the points that changed component,
/// even if the root of a segment of a million points changes.
class ComponentNames {
 public:
  ComponentNames(Vertices& vertices, const JoinForest& forest)
      : vertices_(vertices), forest_(forest) {}

  /// Names the components after a run of ChangePropagation. `touched` are the added vertices and
  /// all whose host or guests changed; all are marked is_touched, and unmarked here. `removed` are
  /// gone.
  void update(std::vector<PointIndex>& touched, std::span<const PointIndex> removed);
  /// The same after the whole forest was rebuilt.
  void update_all(std::span<const PointIndex> removed);

  std::span<const ComponentId> of_points() const { return names_.span(); }
  /// Ascending, as SegmentationEngine::changed().
  std::span<const PointIndex> changed() const { return changed_; }
  PointIndex root(ComponentId name) const { return roots_[name]; }

  void swap_to(SwapSpace& space) {
    names_.swap_to(space);
    roots_.swap_to(space);
  }
  std::size_t bytes() const {
    return names_.bytes() + roots_.bytes() + free_.capacity() * sizeof(ComponentId);
  }

 private:
  /// Points of one component that had one name before.
  struct Share {
    std::uint32_t component;  ///< position of its root in the list that names are given to
    ComponentId old_name;
    std::uint32_t num_points;
  };

  bool is_live_root(PointIndex x) const;
  std::vector<std::uint32_t> find_components() const;
  std::vector<Share> count_pieces(std::span<const PointIndex> touched) const;
  std::vector<ComponentId> give_names(std::vector<Share> shares, std::span<const PointIndex> roots,
                                      std::span<const PointIndex> removed);
  void release_names(std::span<const Share> shares, std::span<const PointIndex> removed,
                     const std::vector<ComponentId>& kept);
  void relabel_piece(PointIndex top, ComponentId name);
  void set_name(PointIndex x, ComponentId name);

  Vertices& vertices_;
  const JoinForest& forest_;
  GrowingArray<ComponentId> names_;  ///< of points
  GrowingArray<PointIndex> roots_;   ///< by name, where it is in use
  std::vector<ComponentId> free_;    ///< names that are not in use
  std::vector<PointIndex> changed_;
};

}  // namespace kintsugi::segmenter::exact
