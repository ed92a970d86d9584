#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "segmenter/core/engine/engine.hpp"
#include "segmenter/core/exact/join_forest.hpp"
#include "segmenter/core/exact/vertex.hpp"

namespace kintsugi::segmenter::exact {

/// Names the components so that few points change name: a component keeps the name that most of
/// its points had, and only pieces that hung elsewhere before are relabelled. So a run costs time
/// in proportion to the vertices it touched and the points that changed component, also when the
/// root of a segment of a million points is another now.
class ComponentNames {
 public:
  ComponentNames(Vertices& vertices, const JoinForest& forest)
      : vertices_(vertices), forest_(forest) {}

  /// Takes over a run. `touched`: the vertices whose host changed or that lost a guest, the added
  /// ones among them; all are is_touched, and none is afterwards. `removed` are gone.
  void update(std::vector<PointIndex>& touched, std::span<const PointIndex> removed);
  /// Takes over a forest that was built anew, with all its points.
  void update_all(std::span<const PointIndex> removed);

  std::span<const ComponentId> of_points() const { return names_.span(); }
  /// Ascending, as SegmentationEngine::changed().
  std::span<const PointIndex> changed() const { return changed_; }
  PointIndex root(ComponentId name) const { return roots_[name]; }

  std::size_t bytes() const {
    return names_.bytes() + roots_.bytes() + free_.capacity() * sizeof(ComponentId);
  }

 private:
  /// Points of one component that had one name before.
  struct Share {
    std::uint32_t component;  ///< place of its root in the list at hand
    ComponentId old_name;
    std::uint32_t num_points;
  };

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
  GrowingArray<PointIndex> roots_;   ///< of names in use
  std::vector<ComponentId> free_;
  std::vector<PointIndex> changed_;
};

}  // namespace kintsugi::segmenter::exact
