#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "segmenter/core/graph/neighbour_index.hpp"
#include "segmenter/core/points/point_cloud.hpp"

namespace kintsugi::segmenter {

/// Parameters of the segmentation; the defaults are the paper's. presets.hpp has others.
struct EngineConfig {
  double threshold = 0.001;   ///< T, the join threshold of a single point, > 0
  double scale = 0.0005;      ///< k, bias towards large segments, > 0
  double color_weight = 0.0;  ///< lambda: share of the colour difference in weights, >= 0; 0: none
  /// Felzenszwalb and Huttenlocher's last step joins segments of fewer points to a neighbour. Told
  /// for points 1 cm apart; at other resolutions it is the same area. >= 0; 0: no such step.
  double min_points = 0.0;
  double beta = 0.85;          ///< of Eq. 4, in (0, 1); mode `voting`
  double resolution_m = 0.01;  ///< voxel size of the map, > 0
  double radius_factor = 2.0;  ///< neighbours are closer than radius_factor * resolution_m, > 0
  /// Mode `exact` builds its state anew when more points come and go than this share of the map (a
  /// point that moves does both). Measured: to come or go costs 2 us, a point of the build 1 us.
  double rebuild_share = 0.4;  ///< >= 0
  /// Or when more points than this share must be looked at again, at 3 us each.
  double explore_share = 0.04;             ///< >= 0
  std::int64_t explore_at_least = 20'000;  ///< points, >= 0: small maps are not worth it
  /// Mode `exact`: hold each update against batch, and throw AuditError at the first difference.
  bool audit = false;
  NeighbourSearch neighbour_search = NeighbourSearch::kGrid;

  /// r, as the float32 that squared distances are compared with.
  float radius_m() const { return static_cast<float>(radius_factor * resolution_m); }
  /// No threshold theta exceeds T + k: edges of this weight and more never join anything.
  double max_weight() const { return threshold + scale; }
  /// min_points at this resolution: segments of fewer points are fragments; 0: there are none.
  std::int64_t fragment_limit() const;
  /// Throws std::invalid_argument naming field, value and bound.
  void validate() const;
};

/// What one run did.
struct RunStatistics {
  std::int64_t num_edges = 0;       ///< edges built: undirected, those that can never join left out
  std::int64_t num_joins = 0;       ///< of the last iteration
  std::int64_t num_points = 0;      ///< points (re-)segmented
  std::int32_t num_iterations = 0;  ///< voting rounds; 1 for the others
  std::int64_t num_explored = 0;    ///< `exact`: old points that looked at their edges again
  bool is_rebuilt = false;          ///< `exact`: from scratch, as that was the cheaper way
  double neighbours_ms = 0.0;       ///< `exact`: to find points and edges
  double replay_ms = 0.0;           ///< `exact`: to decide joins
  double naming_ms = 0.0;           ///< `exact`: to name the components that changed
  double fragments_ms = 0.0;        ///< `exact`, `voting`: to join fragments to their neighbours
};

/// Names a component. Names are below the size() of the cloud, and mean nothing more: those of two
/// engines are compared by canonical_labels().
using ComponentId = std::uint32_t;

/// The component of a point that is not in the cloud (any more).
inline constexpr ComponentId kNoComponent = UINT32_MAX;

/// Keeps the partition of a changing cloud into components.
class SegmentationEngine {
 public:
  virtual ~SegmentationEngine() = default;

  /// Takes over what the cloud's take_change() tells. For `batch` and `exact` the partition depends
  /// only on the points that are in the cloud; for `voting` also on how they came.
  virtual RunStatistics update(const CloudChange& change) = 0;

  /// Instead of the first update(), which would be given `everything`: takes over a partition that
  /// was saved, before fragments are joined. `components` by point, each named by its smallest
  /// point; `thetas` by that name. An
  /// engine whose partition depends only on the points makes it anew.
  virtual void resume(const CloudChange& everything,
                      [[maybe_unused]] std::span<const ComponentId> components,
                      [[maybe_unused]] std::span<const double> thetas) {
    update(everything);
  }

  /// A hint, before an update: the update after it will add the points of this slice, as far as is
  /// known. An engine may look for their neighbours meanwhile, on another thread; nothing but time
  /// depends on it.
  virtual void look_ahead(std::span<const CloudPoint> /*slice_W*/) {}

  /// The component of each point, size() of the cloud at the last update(); kNoComponent for those
  /// that are gone.
  virtual std::span<const ComponentId> components() const = 0;

  /// The partition before fragments are joined to their neighbours; components() where they are
  /// not.
  virtual std::span<const ComponentId> unmerged_components() const { return components(); }

  /// The points in the cloud whose component has another name than before the last update(): every
  /// added point, and others that changed component or whose component was renamed. Ascending, each
  /// once.
  virtual std::span<const PointIndex> changed() const = 0;

  /// The join threshold theta of a component that there is; where fragments are joined, that of
  /// the unmerged component that gives it its name.
  virtual double theta(ComponentId component) const = 0;

  /// Memory taken, the cloud left out.
  virtual std::size_t bytes() const = 0;
};

/// The modes make_engine() knows.
std::span<const std::string_view> engine_modes();

/// Makes the engine called `mode` over `cloud`, which must outlive it. Throws std::invalid_argument
/// for an unknown mode (naming those there are) and for an invalid config.
std::unique_ptr<SegmentationEngine> make_engine(std::string_view mode, const PointCloud& cloud,
                                                const EngineConfig& config);

/// Each component named by its smallest point; kNoComponent stays.
std::vector<PointIndex> canonical_labels(std::span<const ComponentId> components);

}  // namespace kintsugi::segmenter
