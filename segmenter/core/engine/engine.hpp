#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "segmenter/core/points/point_cloud.hpp"

namespace kintsugi::segmenter {

/// What one update did.
struct RunStatistics {
  std::int64_t num_edges = 0;   ///< edges built: undirected, without those that never join anything
  std::int64_t num_joins = 0;   ///< `voting`: of the last round
  std::int64_t num_points = 0;  ///< points segmented, or segmented again
  std::int32_t num_iterations = 0;  ///< `voting`: rounds; 1 for the others
  std::int64_t num_explored = 0;    ///< `exact`: old points whose edges were looked at again
  bool is_rebuilt = false;          ///< `exact`: from scratch, because that was cheaper
  double neighbours_ms = 0.0;       ///< `exact`: to find points and edges
  double joins_ms = 0.0;            ///< `exact`: to decide joins
  double naming_ms = 0.0;           ///< `exact`: to name the components that changed
  double fragments_ms = 0.0;        ///< `exact`, `voting`: to join fragments to their neighbours
};

/// Names a component. A name is below the size() of the cloud and has no other meaning: compare the
/// partitions of two engines by canonical_labels().
using ComponentId = std::uint32_t;

/// The component of a point that is not in the cloud, or not any more.
inline constexpr ComponentId kNoComponent = UINT32_MAX;

/// Keeps the partition of a changing cloud into components.
class SegmentationEngine {
 public:
  virtual ~SegmentationEngine() = default;

  /// Takes over a change that the cloud's take_change() returned. For `batch` and `exact` the
  /// partition depends only on the points in the cloud; for `voting` also on the order in which
  /// they came.
  virtual RunStatistics update(const CloudChange& change) = 0;

  /// Whether changes may have points that moved in place. The engine then computes the partition
  /// from all points again.
  virtual bool takes_moves_in_place() const { return false; }

  /// Instead of a first update() with `everything`: goes on with a saved partition, as it was
  /// before fragments were joined. `components` by point, each named by its smallest point;
  /// `thetas` by that name. An engine whose partition depends only on the points ignores both and
  /// computes it again.
  virtual void resume(const CloudChange& everything,
                      [[maybe_unused]] std::span<const ComponentId> components,
                      [[maybe_unused]] std::span<const double> thetas) {
    update(everything);
  }

  /// A hint, given before an update(): the update after that one will probably add the points of
  /// this slice. An engine may look for their neighbours meanwhile, in another thread. The hint
  /// changes only the time that updates take.
  virtual void look_ahead(std::span<const CloudPoint> /*slice_W*/) {}

  /// The component of each point; kNoComponent for those that are gone. As many as the cloud's
  /// size() at the last update.
  virtual std::span<const ComponentId> components() const = 0;

  /// The same before fragments are joined to their neighbours. Equal to components() where there is
  /// no fragment step.
  virtual std::span<const ComponentId> unmerged_components() const { return components(); }

  /// The points in the cloud whose entry in components() is not what it was before the last
  /// update: all added points, and those whose component is another or was renamed. Ascending, each
  /// once.
  virtual std::span<const PointIndex> changed() const = 0;

  /// The join threshold theta of an existing component. Where fragments are joined, it is that of
  /// the unmerged component with this name.
  virtual double theta(ComponentId component) const = 0;

  /// From now on what is not used for long may go to disk, in the modes that know what that is.
  /// Then no call may be at work while `space`, which must outlive the engine, is trimmed.
  virtual void swap_to(SwapSpace& /*space*/) {}

  /// Memory taken, without the cloud.
  virtual std::size_t bytes() const = 0;
};

/// Names each component by its smallest point; kNoComponent stays.
std::vector<PointIndex> canonical_labels(std::span<const ComponentId> components);

}  // namespace kintsugi::segmenter
