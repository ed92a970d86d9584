#include "tests/bench/frame_table.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iomanip>
#include <limits>
#include <numeric>
#include <sstream>
#include <string>

namespace kintsugi::mapper::bench {
namespace {

using Value = std::function<double(const FrameSample&)>;
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

struct Row {
  std::string name;
  Value wall_ms;
  Value cpu_ms;
};

Row stage_row(const std::string& name, double StageTimes::*stage) {
  return {name, [stage](const FrameSample& sample) { return sample.stages.*stage; },
          [stage](const FrameSample& sample) { return sample.stages_cpu.*stage; }};
}

std::vector<Row> rows() {
  return {
      {"read, decode (wait)", [](const FrameSample& s) { return s.read_ms; }, nullptr},
      {"convert, undistort", [](const FrameSample& s) { return s.convert_ms; }, nullptr},
      {"read and convert", [](const FrameSample& s) { return s.read_ms + s.convert_ms; },
       [](const FrameSample& s) { return s.read_convert_cpu_ms; }},
      stage_row("surface pyramid", &StageTimes::prepare_ms),
      stage_row("track", &StageTimes::track_ms),
      stage_row("shift the volume", &StageTimes::shift_ms),
      stage_row("fuse depth and colour", &StageTimes::integrate_ms),
      stage_row("raycast", &StageTimes::raycast_ms),
      {"all of mapping", [](const FrameSample& s) { return s.stages.total_ms(); },
       [](const FrameSample& s) { return s.stages_cpu.total_ms(); }},
      {"**frame**", [](const FrameSample& s) { return s.frame_ms; },
       [](const FrameSample& s) { return s.frame_cpu_ms; }},
      {"frame after which a slice left",
       [](const FrameSample& s) { return s.slice_left ? s.frame_ms : kNone; },
       [](const FrameSample& s) { return s.slice_left ? s.frame_cpu_ms : kNone; }},
  };
}

/// The values of all samples, without NaN.
std::vector<double> values_of(const FrameRun& run, const Value& value) {
  std::vector<double> values;
  if (!value) return values;
  for (const FrameSample& sample : run.samples) {
    const double number = value(sample);
    if (!std::isnan(number)) values.push_back(number);
  }
  return values;
}

double mean(const std::vector<double>& values) {
  if (values.empty()) return kNone;
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

std::string number(double value_ms) {
  if (std::isnan(value_ms)) return "-";
  std::ostringstream text;
  text << std::fixed << std::setprecision(value_ms < 9.95 ? 2 : 1) << value_ms;
  return text.str();
}

void print_cell(std::ostream& out, double median_ms, double p99_ms, double cpu_mean_ms) {
  out << ' ' << number(median_ms) << " / " << number(p99_ms) << " / " << number(cpu_mean_ms)
      << " |";
}

void print_heading(std::ostream& out, const std::vector<FrameRun>& runs) {
  std::string line;
  out << "| ms: wall median / wall p99 / CPU mean |";
  for (const FrameRun& run : runs) {
    std::ostringstream title;
    title << std::fixed << std::setprecision(1) << 1e3 * run.config.pipeline.volume.resolution_m
          << " mm, " << run.config.threads << (run.config.threads == 1 ? " thread" : " threads");
    out << ' ' << title.str() << " |";
    line += "---|";
  }
  out << "\n|---|" << line << '\n';
}

}  // namespace

double percentile(std::vector<double> values, double share) {
  if (values.empty()) return kNone;
  const double last = std::ceil(share * static_cast<double>(values.size())) - 1.0;
  const auto index = static_cast<std::ptrdiff_t>(std::max(0.0, last));
  std::ranges::nth_element(values, values.begin() + index);
  return values[static_cast<std::size_t>(index)];
}

void print_stage_table(std::ostream& out, const std::vector<FrameRun>& runs) {
  print_heading(out, runs);
  for (const Row& row : rows()) {
    out << "| " << row.name << " |";
    for (const FrameRun& run : runs) {
      const std::vector<double> wall_ms = values_of(run, row.wall_ms);
      print_cell(out, percentile(wall_ms, 0.5), percentile(wall_ms, 0.99),
                 mean(values_of(run, row.cpu_ms)));
    }
    out << '\n';
  }
  const auto print_threads = [&](const char* name, double FrameRun::*cpu_ms) {
    out << "| " << name << " |";
    for (const FrameRun& run : runs) print_cell(out, kNone, kNone, run.*cpu_ms);
    out << '\n';
  };
  print_threads("of these, threads of the driver", &FrameRun::source_threads_cpu_ms);
  print_threads("of these, slice worker", &FrameRun::slice_worker_cpu_ms);
  out << "| frames / lost / slices |";
  for (const FrameRun& run : runs) {
    out << ' ' << run.samples.size() << " / " << run.frames_lost << " / " << run.slices << " |";
  }
  out << '\n';
}

}  // namespace kintsugi::mapper::bench
