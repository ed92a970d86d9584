#pragma once
// What Finman, Whelan, Paull and Leonard report (ICRA 2014), to stand beside our figures: measured
// on their datasets, on an Intel Core i7-3960X at 3.30 GHz.

#include <array>
#include <cstdint>
#include <string_view>

namespace kintsugi::segmenter::paper {

/// Tables I and II.
struct Dataset {
  std::string_view name;
  std::int64_t num_vertices;
  std::int64_t num_slices;
  double build_time_s;
  double length_m;
  double max_ms;  ///< per slice, as the next two
  double min_ms;
  double average_ms;
  double total_s;
  std::int64_t max_slices_behind;
  double mean_slices_behind;
};

inline constexpr std::array<Dataset, 3> kDatasets{{
    {"Office", 60'265, 21, 12.49, 2.9, 446.38, 2.88, 193.1, 4.10, 2, 0.2},
    {"Loop", 1'163'049, 164, 100.22, 14.7, 793.07, 4.80, 302.7, 51.13, 2, 0.9},
    {"Two floors", 3'878'785, 903, 508.0, 107.6, 1162.63, 3.75, 335.09, 311.43, 11, 3.4},
}};

/// Section V-A, Fig. 4: the share of segments with v = 1 on Two floors.
inline constexpr double kExactShare = 0.81;

}  // namespace kintsugi::segmenter::paper
