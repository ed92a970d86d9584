// Cost of publishing, saving, describing, querying and resuming a whole map: a late listener,
// --save-every, kintsugi-query and --resume. Prints a Markdown table.
//
//   bench_whole_map --points 4000000

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <iostream>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <oneapi/tbb/task_arena.h>

#include "lcmtypes/stream/stream_publisher.hpp"
#include "segmenter/description/segment_description.hpp"
#include "segmenter/io/map_files.hpp"
#include "segmenter/io/saved_map.hpp"
#include "segmenter/io/segments_csv.hpp"
#include "segmenter/map/map_snapshot.hpp"
#include "segmenter/query/answer.hpp"
#include "segmenter/query/map_excerpt.hpp"
#include "tests/bench/map_generator.hpp"
#include "tests/support/temporary_folder.hpp"

namespace kintsugi::segmenter::bench {
namespace {

template <class Action>
double time_ms(const Action& action) {
  const auto start = std::chrono::steady_clock::now();
  action();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
      .count();
}

/// The shortest of five runs, which other programs disturb least.
template <class Action>
double best_ms(const Action& action) {
  double best = time_ms(action);
  for (int i = 0; i < 4; ++i) best = std::min(best, time_ms(action));
  return best;
}

void row(const std::string& what, double ms, double bytes) {
  std::cout << fmt::format("| {} | {:.1f} | {:.2f} |\n", what, ms, bytes * 1e-6);
}

double segment(const Slices& slices, std::optional<SegmentMap>& map) {
  double slowest_ms = 0.0;
  CloudSlice slice;
  slice.session = 1;
  slice.resolution_m = 0.01F;
  for (std::size_t i = 0; i < slices.size(); ++i) {
    slice.id = static_cast<std::int32_t>(i);
    slice.kind = i + 1 == slices.size() ? SliceKind::kFinal : SliceKind::kShiftPlusX;
    slice.points_W = slices[i];
    if (!map) map.emplace(SegmentMapConfig{}, 1, slice);
    slowest_ms = std::max(slowest_ms, time_ms([&] { map->add({&slice, 1}); }));
  }
  return slowest_ms;
}

/// Time to send the state at the default rate, without losses.
double send_ms(const std::vector<SegmentUpdate>& state, std::int64_t& bytes) {
  StreamPublisher publisher(
      [&](const std::string&, ByteView message) {
        bytes += static_cast<std::int64_t>(message.size());
      },
      "SEGMENT_UPDATE", 1, {});
  return time_ms([&] {
    publisher.publish_state(state);
    publisher.flush();
  });
}

/// The segment of about this many points.
const SegmentStatistics& segment_of_size(std::span<const SegmentStatistics> segments,
                                         std::uint32_t num_points) {
  return *std::ranges::min_element(segments, {}, [&](const SegmentStatistics& segment) {
    return std::abs(std::int64_t{segment.num_points} - num_points);
  });
}

/// Descriptions of segments, on all cores.
void describe_rows(const MapSnapshot& map) {
  const LabelledCloud cloud = labelled_cloud(map);
  AdjacencyGraph graph;
  const double graph_ms = best_ms([&] { graph = adjacency_graph(cloud); });
  row(fmt::format("adjacency graph of the segments, {} edges (in the background)",
                  graph.edges.size()),
      graph_ms, static_cast<double>(graph.edges.size() * sizeof(AdjacencyEdge)));
  std::vector<SegmentDescription> segments;
  const double describe_ms = best_ms(
      [&] { segments = describe_segments(cloud, map.segments, map.state.last_changes, graph); });
  row("description of every segment, given the graph (in the background)", describe_ms,
      static_cast<double>(segments.size() * sizeof(SegmentDescription)));
  for (const std::uint32_t num_points : {1000U, UINT32_MAX}) {
    const SegmentStatistics& segment = segment_of_size(map.segments, num_points);
    row(fmt::format("description of one segment of {} points", segment.num_points),
        best_ms([&] { describe_segment(map, segment.segment_id); }), 0.0);
  }
  const kintsugi::testing::TemporaryFolder folder;
  const double write_ms = time_ms([&] {
    write_segments_json(map, segments, folder / "segments.json");
    write_segments_csv(segments, folder / "segments.csv");
  });
  row("segments.json and .csv written (in the background)", write_ms,
      static_cast<double>(std::filesystem::file_size(folder / "segments.json") +
                          std::filesystem::file_size(folder / "segments.csv")));
}

/// Queries on a copy of the map, as the segmenter answers them while slices are added.
void query_rows(const MapSnapshot& map) {
  SegmentQuery query;
  query.client = 1;
  query.max_segments = 1;
  row("query for the largest segment (in the background)", best_ms([&] { answer(map, query); }),
      0.0);
  query.only_planar = true;
  query.max_segments = 10;
  row("query for the ten largest planar segments (in the background)",
      best_ms([&] { answer(map, query); }), 0.0);
}

/// Queries for the segment at a point or pixel, from an excerpt of the map.
void excerpt_rows(const SegmentMap& map, std::span<const SegmentStatistics> segments) {
  for (const std::uint32_t num_points : {1000U, UINT32_MAX}) {
    const SegmentStatistics& segment = segment_of_size(segments, num_points);
    const auto points = map.segment_ids().points_of(segment.segment_id);
    const CloudPoint& point = map.cloud()[*points.begin()];
    SegmentQuery query;
    query.client = 1;
    query.place = QueryPlace::kPoint;
    query.point_W[0] = point.x;
    query.point_W[1] = point.y;
    query.point_W[2] = point.z;
    MapExcerpt excerpt;
    const double take_ms = best_ms([&] { take_excerpt(map, query, nullptr, excerpt); });
    row(fmt::format("excerpt for the segment of {} points at a point (holds the engine)",
                    segment.num_points),
        take_ms, static_cast<double>(excerpt.points_W.size()) * 36);
    row("answer from it, on one core (in the background)",
        best_ms([&] { oneapi::tbb::task_arena(1).execute([&] { answer(excerpt, query); }); }), 0.0);
  }
}

void run(const MapConfig& config) {
  const Slices slices = generate_map(config);
  std::optional<SegmentMap> map;
  const double slowest_ms = segment(slices, map);
  const double num_points = map->cloud().num_live();
  std::cout << fmt::format(
      "{} points, {} slices, {} segments; the slowest slice took {:.1f} ms\n\n",
      map->cloud().num_live(), slices.size(), map->segment_ids().num_segments(), slowest_ms);
  std::cout << "| what | ms | MB |\n|---|---|---|\n";
  std::vector<SegmentUpdate> state;
  const double describe_ms = best_ms([&] { state = map->describe(); });
  std::int64_t bytes = 0;
  const double sending_ms = send_ms(state, bytes);
  row("full state made (holds the engine)", describe_ms, static_cast<double>(bytes));
  row("full state sent at 10 MB/s", sending_ms, static_cast<double>(bytes));

  std::optional<MapSnapshot> snapshot;
  const double copy_ms = best_ms([&] {
    snapshot.reset();
    snapshot = take_snapshot(*map);
  });
  row("first copy of the map (holds the engine)", copy_ms, num_points * 36);
  const double again_ms = best_ms([&] { take_snapshot(*map, *snapshot); });
  row("copy into the memory of an earlier one (holds the engine)", again_ms, num_points * 36);
  const kintsugi::testing::TemporaryFolder folder;
  const auto file = folder / "map.kseg";
  const double write_ms = time_ms([&] { write_map_state(snapshot->state, file); });
  row("copy written to a file (in the background)", write_ms,
      static_cast<double>(std::filesystem::file_size(file)));
  describe_rows(*snapshot);
  query_rows(*snapshot);
  excerpt_rows(*map, snapshot->segments);
  snapshot.reset();
  map.reset();
  row("saved map read and engine rebuilt (--resume)", time_ms([&] { load_map(file); }),
      num_points * 36);
}

}  // namespace
}  // namespace kintsugi::segmenter::bench

int main(int argc, char** argv) {
  using namespace kintsugi::segmenter::bench;
  MapConfig config;
  CLI::App app("Cost of publishing, saving and querying a whole map");
  app.add_option("--points", config.num_points, "size of the generated map")->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  try {
    run(config);
  } catch (const std::exception& error) {
    std::cerr << "bench_whole_map: " << error.what() << '\n';
    return 1;
  }
}
