#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "segmenter/core/neighbour_index.hpp"
#include "segmenter/core/point_cloud.hpp"

namespace kintsugi::segmenter {

/// Parameters of the segmentation; the defaults are the paper's.
struct EngineConfig {
  double threshold = 0.001;    ///< T, the join threshold of a single point, > 0
  double scale = 0.0005;       ///< k, bias towards large segments, > 0
  double beta = 0.85;          ///< of Eq. 4, in (0, 1); mode `voting`
  double resolution_m = 0.01;  ///< voxel size of the map, > 0
  double radius_factor = 2.0;  ///< neighbours are closer than radius_factor * resolution_m, > 0
  NeighbourSearch neighbour_search = NeighbourSearch::kGrid;

  /// r, as the float32 that squared distances are compared with.
  float radius_m() const { return static_cast<float>(radius_factor * resolution_m); }
  /// Throws std::invalid_argument naming field, value and bound.
  void validate() const;
};

/// What one run did.
struct RunStatistics {
  std::int64_t num_edges = 0;       ///< edges built: undirected, those that can never join left out
  std::int64_t num_joins = 0;       ///< of the last iteration
  std::int64_t num_points = 0;      ///< points (re-)segmented
  std::int32_t num_iterations = 0;  ///< voting rounds; 1 for `batch`
};

/// Keeps the partition of a growing cloud into components.
///
/// A component is named by its representative, one of its points. The engines `batch` and `voting`
/// take the smallest index; use canonical_labels() to compare with others.
class SegmentationEngine {
 public:
  virtual ~SegmentationEngine() = default;

  /// Segments the points appended to the cloud since the last call. The partition depends only on
  /// the points and, for incremental modes, on how they were divided over the calls.
  virtual RunStatistics update() = 0;

  /// The representative of each point's component, size() of the cloud at the last update().
  /// `components()[r] == r` iff r is a representative.
  virtual std::span<const PointIndex> components() const = 0;

  /// The points whose representative differs from the one before the last update(): every new
  /// point, and older ones whose component was renamed. Ascending, each once.
  virtual std::span<const PointIndex> changed() const = 0;

  /// The join threshold theta of the component that `representative` names.
  virtual double theta(PointIndex representative) const = 0;
};

/// The modes make_engine() knows.
std::span<const std::string_view> engine_modes();

/// Makes the engine called `mode` over `cloud`, which must outlive it. Throws std::invalid_argument
/// for an unknown mode (naming those there are) and for an invalid config.
std::unique_ptr<SegmentationEngine> make_engine(std::string_view mode, const PointCloud& cloud,
                                                const EngineConfig& config);

/// Each component named by its smallest point instead of its representative.
std::vector<PointIndex> canonical_labels(std::span<const PointIndex> components);

}  // namespace kintsugi::segmenter
