#include "segmenter/evaluation/trajectory/trajectory_report.hpp"

#include <cmath>
#include <stdexcept>
#include <string_view>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>
#include <spdlog/fmt/fmt.h>

#include "lcmtypes/base/json_text.hpp"

namespace kintsugi::segmenter {
namespace {

constexpr double kDegreesPerRadian = 180.0 / M_PI;

struct NamedErrors {
  std::string name;   ///< in files
  std::string label;  ///< for people
  ErrorStatistics statistics;
};

struct NamedValue {
  std::string_view name;
  double value = 0.0;
};

std::vector<NamedValue> values_of(const ErrorStatistics& statistics) {
  return {{"rmse", statistics.rmse}, {"mean", statistics.mean}, {"median", statistics.median},
          {"std", statistics.std},   {"min", statistics.min},   {"max", statistics.max}};
}

ErrorStatistics in_degrees(ErrorStatistics statistics) {
  for (double* value : {&statistics.rmse, &statistics.mean, &statistics.median, &statistics.std,
                        &statistics.min, &statistics.max}) {
    *value *= kDegreesPerRadian;
  }
  return statistics;
}

std::string_view name_of(DeltaUnit unit) {
  switch (unit) {
    case DeltaUnit::kSeconds:
      return "s";
    case DeltaUnit::kFrames:
      return "f";
    case DeltaUnit::kMetres:
      return "m";
    case DeltaUnit::kDegrees:
      return "deg";
  }
  return "";
}

std::string delta_text(const RelativeTrajectoryErrorConfig& config) {
  return config.fixed_delta ? fmt::format("{:g} {}", config.delta, name_of(config.delta_unit))
                            : "all pairs";
}

std::vector<NamedErrors> errors_of(const TrajectoryReport& report) {
  const std::string rpe = "RPE, " + delta_text(report.relative_config);
  std::vector<NamedErrors> errors = {
      {"ate_m", "ATE, m", report.absolute.translation_m},
      {"rpe_m", rpe + ", m", report.relative.translation_m},
      {"rpe_deg", rpe + ", deg", in_degrees(report.relative.rotation_rad)}};
  if (report.per_metre) {
    errors.push_back({"rpe_per_metre_m", "RPE, 1 m of path, m", report.per_metre->translation_m});
    errors.push_back(
        {"rpe_per_metre_deg", "RPE, 1 m of path, deg", in_degrees(report.per_metre->rotation_rad)});
  }
  return errors;
}

std::vector<NamedValue> drift_of(const TrajectoryReport& report) {
  const PathDrift& drift = report.drift;
  return {{"path_length_m", drift.path_length_m},
          {"end_translation_m", drift.end_translation_m},
          {"end_rotation_deg", drift.end_rotation_rad * kDegreesPerRadian},
          {"drift_percent", drift.percent()}};
}

/// None where the path is too short to hold two motions of a metre.
std::optional<RelativeTrajectoryError> error_per_metre(const Trajectory& estimate,
                                                       const Trajectory& truth) {
  try {
    return relative_trajectory_error(estimate, truth,
                                     {.delta = 1.0, .delta_unit = DeltaUnit::kMetres});
  } catch (const std::invalid_argument&) {
    return std::nullopt;
  }
}

}  // namespace

TrajectoryReport report_trajectory(const Trajectory& estimate, const Trajectory& truth,
                                   const RelativeTrajectoryErrorConfig& config) {
  TrajectoryReport report;
  report.num_estimated = estimate.size();
  report.num_true = truth.size();
  report.absolute = absolute_trajectory_error(estimate, truth);
  report.relative_config = config;
  report.relative = relative_trajectory_error(estimate, truth, config);
  report.per_metre = error_per_metre(estimate, truth);
  report.drift = path_drift(estimate, truth);
  return report;
}

std::string to_text(const TrajectoryReport& report) {
  std::string text =
      fmt::format("estimate: {}, {} poses\ntruth: {}, {} poses\n", report.estimate_name,
                  report.num_estimated, report.truth_name, report.num_true);
  text += fmt::format("\n{:<24}{:>8}", "", "pairs");
  for (const auto& [name, value] : values_of({})) text += fmt::format("{:>10}", name);
  for (const auto& [name, label, statistics] : errors_of(report)) {
    text += fmt::format("\n{:<24}{:>8}", label, statistics.count);
    for (const auto& [statistic, value] : values_of(statistics)) {
      text += fmt::format("{:>10.5f}", value);
    }
  }
  const PathDrift& drift = report.drift;
  return text + fmt::format(
                    "\n\npath {:.3f} m; its end is off by {:.4f} m and {:.3f} deg when its "
                    "beginning is right: {:.3f} % of the path\n",
                    drift.path_length_m, drift.end_translation_m,
                    drift.end_rotation_rad * kDegreesPerRadian, drift.percent());
}

Table to_table(const TrajectoryReport& report) {
  Table table;
  table.header = {"estimate", "truth", "poses", "delta"};
  table.rows = {{report.estimate_name, report.truth_name, std::to_string(report.num_estimated),
                 delta_text(report.relative_config)}};
  const auto add = [&](const std::string& name, std::string cell) {
    table.header.push_back(name);
    table.rows[0].push_back(std::move(cell));
  };
  for (const auto& [name, value] : drift_of(report)) add(std::string(name), decimal(value, 6));
  for (const auto& [error, label, statistics] : errors_of(report)) {
    add(error + "_pairs", std::to_string(statistics.count));
    for (const auto& [statistic, value] : values_of(statistics)) {
      add(fmt::format("{}_{}", error, statistic), decimal(value, 6));
    }
  }
  return table;
}

std::string to_json(const TrajectoryReport& report) {
  nlohmann::ordered_json json = {{"estimate", report.estimate_name},
                                 {"truth", report.truth_name},
                                 {"poses", report.num_estimated},
                                 {"delta", delta_text(report.relative_config)}};
  for (const auto& [name, value] : drift_of(report)) json[std::string(name)] = value;
  for (const auto& [error, label, statistics] : errors_of(report)) {
    json[error]["pairs"] = statistics.count;
    for (const auto& [statistic, value] : values_of(statistics)) {
      json[error][std::string(statistic)] = value;
    }
  }
  return json_text(json, 2) + "\n";
}

}  // namespace kintsugi::segmenter
