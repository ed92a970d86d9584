#pragma once
// The errors of a camera path, for people and for programs.

#include <cstddef>
#include <optional>
#include <string>

#include "lcmtypes/trajectory.hpp"
#include "segmenter/evaluation/report/table.hpp"
#include "segmenter/evaluation/trajectory/relative_trajectory_error.hpp"
#include "segmenter/evaluation/trajectory/trajectory_error.hpp"

namespace kintsugi::segmenter {

/// All that kintsugi-evaluate --trajectory tells of one path.
struct TrajectoryReport {
  std::string estimate_name;
  std::string truth_name;
  std::size_t num_estimated = 0;  ///< poses
  std::size_t num_true = 0;       ///< poses
  AbsoluteTrajectoryError absolute;
  RelativeTrajectoryErrorConfig relative_config;
  RelativeTrajectoryError relative;
  std::optional<RelativeTrajectoryError> per_metre;  ///< none where the path is shorter
  PathDrift drift;
};

/// @throws std::invalid_argument as the functions of the errors do
TrajectoryReport report_trajectory(const Trajectory& estimate, const Trajectory& truth,
                                   const RelativeTrajectoryErrorConfig& config);

/// What a person reads.
std::string to_text(const TrajectoryReport& report);
/// One row; a column for each statistic of each error, named as `ate_m_rmse`.
Table to_table(const TrajectoryReport& report);
/// One object; the same names, `ate_m` being an object with `rmse` and so on.
std::string to_json(const TrajectoryReport& report);

}  // namespace kintsugi::segmenter
