#pragma once
// The measurements of the paper, over one recorded session.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "segmenter/core/points/point_cloud.hpp"
#include "segmenter/evaluation/agreement/agreement.hpp"
#include "segmenter/evaluation/paper/theta_history.hpp"
#include "segmenter/evaluation/session/recorded_session.hpp"
#include "segmenter/evaluation/times/lag.hpp"
#include "segmenter/evaluation/times/measured_session.hpp"

namespace kintsugi::segmenter {

/// The modes there are: the incremental ones first, `batch` last.
std::vector<std::string> evaluation_modes();

struct EvaluationConfig {
  std::vector<std::string> modes = evaluation_modes();  ///< at least one, each once
  EngineConfig engine;           ///< its resolution_m is replaced by that of the session
  int batch_every = 0;           ///< mode `batch` runs after every so many steps; 0: see next
  double batch_budget_s = 60.0;  ///< then as often as fits into this time, > 0
  std::vector<int> segments = {1, 2, 3};  ///< whose theta is shown, by rank: 1 is the largest

  /// Throws std::invalid_argument naming field, value and bound.
  void validate() const;
};

/// Of a segment that theta is shown for.
struct ChosenSegment {
  int rank = 0;
  ThetaHistory history;
};

/// One mode over the session.
struct ModeResult {
  MeasuredSession measured;
  bool is_complete = true;                  ///< ran after every step; else it was sampled (`batch`)
  std::vector<std::int64_t> slices_behind;  ///< of each step; empty: no times, or sampled
  std::vector<SegmentAgreement> agreements;  ///< with batch, on the final map
};

struct Evaluation {
  EvaluationConfig config;
  RecordedSession session;
  std::int64_t num_vertices = 0;  ///< points of the final map
  std::int64_t num_segments = 0;  ///< of batch
  /// Of batch, in the order of MeasuredSession::labels.
  std::vector<std::uint32_t> labels;
  std::vector<ModeResult> modes;
  std::vector<ChosenSegment> thetas;
  double batch_final_ms = 0.0;      ///< batch once over the final map
  int batch_every = 1;              ///< as it was done
  std::int64_t resident_bytes = 0;  ///< memory of the process at the end
  std::int64_t peak_resident_bytes = 0;
};

/// The final map, in the order of its labels.
PointCloud final_cloud(const RecordedSession& session);

/// Segments the final map with batch, which is the reference, then measures each mode over the
/// session.
/// @throws std::invalid_argument for an invalid config
Evaluation evaluate(RecordedSession session, EvaluationConfig config,
                    const OnMeasurementProgress& on_progress = {});

}  // namespace kintsugi::segmenter
