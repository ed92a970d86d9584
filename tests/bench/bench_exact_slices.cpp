#include "tests/bench/bench_exact_slices.hpp"

#include <array>
#include <fstream>
#include <iostream>

#include "segmenter/core/ids/segment_ids.hpp"
#include "segmenter/core/make_engine.hpp"
#include "segmenter/map/segment_statistics.hpp"
#include "tests/bench/bench_exact_report.hpp"

namespace kintsugi::segmenter::bench {
namespace {

constexpr double kMillion = 1e6;

/// Times of the stages of one slice, ms.
struct SliceTimes {
  PointIndex num_points_before = 0;
  std::size_t num_points = 0;
  RunStatistics run;
  double engine_ms = 0.0;
  double ids_ms = 0.0;
  double statistics_ms = 0.0;
  double cpu_ms = 0.0;  ///< of all stages

  [[nodiscard]] double total_ms() const { return engine_ms + ids_ms + statistics_ms; }
};

/// The state that a segmenter keeps of a map.
struct SegmentedMap {
  SegmentedMap(const std::string& mode, const EngineConfig& config)
      : engine(make_engine(mode, cloud, config)),
        statistics(static_cast<float>(config.resolution_m)) {}

  SliceTimes add(std::int32_t slice_id, const std::vector<CloudPoint>& points_W) {
    SliceTimes times;
    times.num_points_before = cloud.size();
    times.num_points = points_W.size();
    cloud.add_slice(slice_id, points_W);
    const CloudChange change = cloud.take_change();
    const Stopwatch all;
    times.run = engine->update(change);
    times.engine_ms = all.wall_ms();
    const IdUpdate update = ids.update(cloud, change, engine->components(), engine->changed());
    times.ids_ms = all.wall_ms() - times.engine_ms;
    statistics.apply(cloud, ids, update.changes);
    times.statistics_ms = all.wall_ms() - times.engine_ms - times.ids_ms;
    times.cpu_ms = all.cpu_ms();
    return times;
  }

  PointCloud cloud;
  std::unique_ptr<SegmentationEngine> engine;
  SegmentIds ids;
  SegmentStatisticsTable statistics;
};

template <typename Value>
Sample sample(const std::vector<SliceTimes>& slices, Value value) {
  Sample sample;
  for (const SliceTimes& slice : slices) sample.add(value(slice));
  return sample;
}

void print_times(const char* name, const Sample& times) {
  print_row({name, number(times.average()), number(times.quantile(0.5)),
             number(times.quantile(0.99)), number(times.max())});
}

/// Average over the slices that were added while the map had [first, last) million points.
double average_ms(const std::vector<SliceTimes>& slices, double first, double last) {
  Sample part;
  for (const SliceTimes& slice : slices) {
    const double millions = slice.num_points_before / kMillion;
    if (millions >= first && millions < last) part.add(slice.total_ms());
  }
  return part.average();
}

void print_slices(const std::string& mode, const std::vector<SliceTimes>& slices) {
  print_head({mode + ", ms a slice", "average", "median", "p99", "max"});
  print_times("all", sample(slices, [](const SliceTimes& s) { return s.total_ms(); }));
  print_times("CPU", sample(slices, [](const SliceTimes& s) { return s.cpu_ms; }));
  print_times("engine", sample(slices, [](const SliceTimes& s) { return s.engine_ms; }));
  print_times("- neighbours",
              sample(slices, [](const SliceTimes& s) { return s.run.neighbours_ms; }));
  print_times("- joins", sample(slices, [](const SliceTimes& s) { return s.run.joins_ms; }));
  print_times("- names", sample(slices, [](const SliceTimes& s) { return s.run.naming_ms; }));
  print_times("- fragments",
              sample(slices, [](const SliceTimes& s) { return s.run.fragments_ms; }));
  print_times("ids", sample(slices, [](const SliceTimes& s) { return s.ids_ms; }));
  print_times("statistics", sample(slices, [](const SliceTimes& s) { return s.statistics_ms; }));
}

void print_map(const std::string& mode, const SegmentedMap& map,
               const std::vector<SliceTimes>& slices, std::size_t process_bytes) {
  const double num_points = map.cloud.size();
  const double millions = num_points / kMillion;
  const auto per_point = [&](std::size_t bytes) {
    return number(static_cast<double>(bytes) / num_points);
  };
  print_head({mode, ""});
  print_row({"points", count(map.cloud.size())});
  print_row({"slices", count(slices.size())});
  print_row({"segments", count(static_cast<std::size_t>(map.ids.num_segments()))});
  if (millions >= 2.0) {
    print_row({"first million, ms a slice", number(average_ms(slices, 0.0, 1.0))});
    print_row({"last million, ms a slice", number(average_ms(slices, millions - 1.0, millions))});
  }
  print_row({"engine, bytes a point", per_point(map.engine->bytes())});
  print_row({"ids, bytes a point", per_point(map.ids.bytes())});
  print_row({"process, bytes a point (32 of them the point)", per_point(process_bytes)});
}

void write_csv(const std::filesystem::path& file, const std::vector<SliceTimes>& slices) {
  std::ofstream out(file);
  out << "slice,map_points,points,total_ms,cpu_ms,neighbours_ms,joins_ms,naming_ms,fragments_ms,"
         "ids_ms,"
         "statistics_ms,edges,joins,explored,rebuilt\n";
  for (std::size_t k = 0; k < slices.size(); ++k) {
    const SliceTimes& s = slices[k];
    out << k << ',' << s.num_points_before << ',' << s.num_points << ',' << s.total_ms() << ','
        << s.cpu_ms << ',' << s.run.neighbours_ms << ',' << s.run.joins_ms << ',' << s.run.naming_ms
        << ',' << s.run.fragments_ms << ',' << s.ids_ms << ',' << s.statistics_ms << ','
        << s.run.num_edges << ',' << s.run.num_joins << ',' << s.run.num_explored << ','
        << s.run.is_rebuilt << '\n';
  }
  if (!out) throw std::runtime_error(file.string() + ": cannot be written");
}

}  // namespace

void bench_slices(const std::string& mode, const EngineConfig& config, const Slices& slices,
                  const std::filesystem::path& csv) {
  const std::size_t bytes_before = resident_bytes();
  SegmentedMap map(mode, config);
  std::vector<SliceTimes> times;
  for (std::size_t k = 0; k < slices.size(); ++k) {
    times.push_back(map.add(static_cast<std::int32_t>(k), slices[k]));
    if (k % 50 == 0) std::cerr << mode << ": slice " << k << " of " << slices.size() << '\r';
  }
  print_slices(mode, times);
  print_map(mode, map, times, resident_bytes() - bytes_before);
  if (!csv.empty()) write_csv(csv, times);
}

void bench_whole(const std::string& mode, const EngineConfig& config, const Slices& slices) {
  constexpr int kRuns = 3;
  PointCloud cloud;
  cloud.add_slice(0, all_points(slices));
  const CloudChange everything = cloud.take_change();
  Sample wall_ms;
  Sample cpu_ms;
  std::size_t bytes = 0;
  for (int run = 0; run < kRuns; ++run) {
    const auto engine = make_engine(mode, cloud, config);
    const Stopwatch stopwatch;
    engine->update(everything);
    wall_ms.add(stopwatch.wall_ms());
    cpu_ms.add(stopwatch.cpu_ms());
    bytes = engine->bytes();
  }
  print_head({mode + ", all at once", ""});
  print_row({"points", count(cloud.size())});
  print_row({"wall, ms (median of 3)", number(wall_ms.quantile(0.5))});
  print_row({"CPU, ms (median of 3)", number(cpu_ms.quantile(0.5))});
  print_row({"kept, bytes a point", number(static_cast<double>(bytes) / cloud.size())});
}

}  // namespace kintsugi::segmenter::bench
