#pragma once
// Compares the quality of segmentations with different parameters, over one recorded session whose
// true instances are known.

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "segmenter/evaluation/comparison/parameter_sets.hpp"
#include "segmenter/evaluation/quality/ground_truth.hpp"
#include "segmenter/evaluation/quality/quality.hpp"
#include "segmenter/evaluation/session/recorded_session.hpp"

namespace kintsugi::segmenter {

/// Instead of the name of a preset: the segment_id that the session's cloud has.
inline constexpr char kGivenLabels[] = "labels";
/// Instead of the name of a preset: ComparisonConfig::engine.
inline constexpr char kGivenEngine[] = "flags";

struct ComparisonConfig {
  /// Names of presets, kGivenLabels or kGivenEngine: at least one, each once.
  std::vector<std::string> presets = {"paper", "objects"};
  bool sweep = false;     ///< also the preset `objects` with one parameter at a time changed
  EngineConfig engine;    ///< of kGivenEngine
  QualityConfig quality;  ///< its boundary is replaced by the radius and tolerance below
  double match_distance_vox = 1.0;      ///< maximum distance to the true point, > 0
  double boundary_radius_vox = 2.0;     ///< > 0
  double boundary_tolerance_vox = 1.0;  ///< in [0, boundary_radius_vox)

  /// Throws std::invalid_argument naming field, value and bound.
  void validate() const;
};

/// Of one set of parameters.
struct ComparedResult {
  ParameterSet variant;
  SegmentationQuality quality;
  double segmentation_ms = 0.0;  ///< wall time of batch over the whole map; 0 for given labels
};

struct Comparison {
  ComparisonConfig config;
  std::string source;
  std::string truth_source;
  double resolution_m = 0.0;
  std::int64_t num_points = 0;    ///< of the map, that can be segmented
  std::int64_t num_rejected = 0;  ///< others
  std::vector<TruthInstance> instances;
  std::vector<ComparedResult> presets;  ///< in the order of the config
  std::vector<ComparedResult> sweep;    ///< in the order of sweep_around()
  std::vector<std::string> remarks;
};

/// Called with each result as soon as it is known, and the total number of results.
using OnComparedResult = std::function<void(const ComparedResult&, std::size_t num_results)>;

/// Segments the final map by batch with each set of parameters.
/// @throws std::invalid_argument for an invalid config, and when labels are asked for but the
/// session
///   has none
/// @throws std::runtime_error when no point of the map has a true instance
Comparison compare_parameters(const RecordedSession& session, const Truth& truth,
                              const ComparisonConfig& config,
                              const OnComparedResult& on_result = {});

}  // namespace kintsugi::segmenter
