#include "tests/bench/bench_exact_corrections.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>

#include "segmenter/core/make_engine.hpp"
#include "tests/bench/bench_exact_report.hpp"
#include "tests/fuzz/partition.hpp"
#include "tests/fuzz/random.hpp"

namespace kintsugi::segmenter::bench {
namespace {

using fuzz::Random;

/// A map whose points are added and removed one by one. The cloud keeps removed points: replacing a
/// whole slice for each of them would cost more than what is measured.
class EditableMap {
 public:
  EditableMap(const std::string& mode, const EngineConfig& config, const Slices& slices,
              bool measures_cpu)
      : engine_(make_engine(mode, cloud_, config)), measures_cpu_(measures_cpu) {
    for (const auto& slice : slices) edit({}, slice);
  }

  struct Edit {
    double ms;  ///< time of the engine
    bool is_rebuilt;
    PointIndex first_added;
  };

  Edit edit(std::vector<PointIndex> removed, const std::vector<CloudPoint>& added_W) {
    const SliceRecord& slice =
        cloud_.add_slice(static_cast<std::int32_t>(cloud_.slices().size()), added_W);
    const PointIndex first = slice.first;
    CloudChange change = cloud_.take_change();
    change.removed = std::move(removed);
    is_gone_.resize(cloud_.size(), false);
    for (const PointIndex i : change.removed) is_gone_[i] = true;
    const Stopwatch stopwatch;
    const RunStatistics run = engine_->update(change);
    const double ms = measures_cpu_ ? stopwatch.cpu_ms() : stopwatch.wall_ms();
    return {ms, run.is_rebuilt, first};
  }

  [[nodiscard]] PointIndex random_point(Random& random) const {
    PointIndex i = 0;
    do {
      i = static_cast<PointIndex>(random.below(cloud_.size()));
    } while (is_gone_[i]);
    return i;
  }

  /// Ascending.
  template <typename Wanted>
  [[nodiscard]] std::vector<PointIndex> points_where(Wanted wanted) const {
    std::vector<PointIndex> points;
    for (PointIndex i = 0; i < cloud_.size(); ++i) {
      if (!is_gone_[i] && wanted(cloud_[i])) points.push_back(i);
    }
    return points;
  }

  [[nodiscard]] std::vector<PointIndex> all_points() const {
    return points_where([](const CloudPoint&) { return true; });
  }

  [[nodiscard]] const CloudPoint& operator[](PointIndex i) const { return cloud_[i]; }
  [[nodiscard]] const SegmentationEngine& engine() const { return *engine_; }

 private:
  PointCloud cloud_;
  std::unique_ptr<SegmentationEngine> engine_;
  bool measures_cpu_;
  std::vector<bool> is_gone_;
};

CloudPoint with_normal(CloudPoint p, double nx, double ny, double nz) {
  const double length = std::sqrt(nx * nx + ny * ny + nz * nz);
  p.nx = static_cast<float>(nx / length);
  p.ny = static_cast<float>(ny / length);
  p.nz = static_cast<float>(nz / length);
  return p;
}

/// The change when another frame is fused: each component changes by 0.002 or not at all.
CloudPoint with_other_normal(Random& random, const CloudPoint& p) {
  constexpr double kTilt = 0.002;
  const auto jitter = [&] { return kTilt * (static_cast<double>(random.below(3)) - 1.0); };
  const double nx = p.nx + jitter();
  const double ny = p.ny + jitter();
  return with_normal(p, nx, ny, p.nz + jitter());
}

/// The change when a pose is corrected: a rotation by 4 mrad about the vertical axis through
/// `centre`, and 2 mm up.
CloudPoint corrected(const CloudPoint& p, const CloudPoint& centre) {
  constexpr double kYaw = 0.004;
  constexpr float kLift_m = 0.002F;
  const double c = std::cos(kYaw);
  const double s = std::sin(kYaw);
  const double x = p.x - centre.x;
  const double y = p.y - centre.y;
  CloudPoint moved = with_normal(p, c * p.nx - s * p.ny, s * p.nx + c * p.ny, p.nz);
  moved.x = static_cast<float>(centre.x + c * x - s * y);
  moved.y = static_cast<float>(centre.y + s * x + c * y);
  moved.z = p.z + kLift_m;
  return moved;
}

struct Row {
  std::string name;
  Sample points = {};
  Sample ms = {};
  std::size_t num_rebuilt = 0;

  void add(std::size_t num_points, const EditableMap::Edit& edit) {
    points.add(static_cast<double>(num_points));
    ms.add(edit.ms);
    num_rebuilt += edit.is_rebuilt;
  }
  void print() const {
    const double us_a_point = 1e3 * ms.average() / std::max(points.average(), 1.0);
    print_row({name, count(ms.size()),
               count(static_cast<std::size_t>(std::lround(points.average()))),
               number(ms.quantile(0.5)), number(ms.quantile(0.9)), number(ms.quantile(0.99)),
               number(ms.max()), number(us_a_point), count(num_rebuilt)});
  }
};

double move_points(EditableMap& map, Random& random, std::size_t count) {
  Row row{.name = "one point gets another normal"};
  for (std::size_t k = 0; k < count; ++k) {
    const PointIndex i = map.random_point(random);
    row.add(1, map.edit({i}, {with_other_normal(random, map[i])}));
  }
  row.print();
  return row.ms.max();
}

double remove_points(EditableMap& map, Random& random, std::size_t count) {
  Row row{.name = "one point is removed"};
  for (std::size_t k = 0; k < count; ++k) row.add(1, map.edit({map.random_point(random)}, {}));
  row.print();
  return row.ms.max();
}

double move_balls(EditableMap& map, Random& random) {
  double max_ms = 0.0;
  for (const float radius_m : {0.02F, 0.05F, 0.1F, 0.2F, 0.4F, 0.8F, 1.2F}) {
    Row row{.name = "ball of " + number(100.0 * radius_m) + " cm is rotated"};
    for (int k = radius_m < 0.3F ? 9 : 3; k > 0; --k) {
      const CloudPoint centre = map[map.random_point(random)];
      const auto ball = map.points_where(
          [&](const CloudPoint& p) { return are_neighbours(p, centre, radius_m); });
      std::vector<CloudPoint> moved_W;
      moved_W.reserve(ball.size());
      for (const PointIndex i : ball) moved_W.push_back(corrected(map[i], centre));
      row.add(ball.size(), map.edit(ball, moved_W));
    }
    row.print();
    max_ms = std::max(max_ms, row.ms.max());
  }
  return max_ms;
}

double move_third(EditableMap& map) {
  constexpr float kShift_m = 0.02F;
  std::vector<float> xs;
  for (const PointIndex i : map.all_points()) xs.push_back(map[i].x);
  const auto third = xs.begin() + static_cast<std::ptrdiff_t>(xs.size() / 3);
  std::ranges::nth_element(xs, third);
  std::vector<PointIndex> points =
      map.points_where([&](const CloudPoint& p) { return p.x < *third; });
  std::vector<CloudPoint> before_W;
  std::vector<CloudPoint> after_W;
  for (const PointIndex i : points) {
    before_W.push_back(map[i]);
    after_W.push_back(map[i]);
    after_W.back().x += kShift_m;
  }
  Row row{.name = "a third of the map is moved by 2 cm, and back"};
  const auto there = map.edit(points, after_W);
  row.add(points.size(), there);
  for (std::size_t k = 0; k < points.size(); ++k) {
    points[k] = there.first_added + static_cast<PointIndex>(k);
  }
  row.add(points.size(), map.edit(points, before_W));
  row.print();
  return row.ms.max();
}

/// Prints the time of batch; returns whether labels and thetas of the engine equal those of batch.
bool equals_batch(const EditableMap& map, const EngineConfig& config, bool measures_cpu,
                  double max_ms) {
  const auto live = map.all_points();
  std::vector<CloudPoint> points_W;
  points_W.reserve(live.size());
  for (const PointIndex i : live) points_W.push_back(map[i]);
  PointCloud cloud;
  cloud.add_slice(0, points_W);
  const auto batch = make_engine("batch", cloud, config);
  const CloudChange change = cloud.take_change();
  const Stopwatch stopwatch;
  batch->update(change);
  const double batch_ms = measures_cpu ? stopwatch.cpu_ms() : stopwatch.wall_ms();
  print_row({"batch over the final points", "1", count(live.size()), number(batch_ms), "", "", "",
             "", ""});
  const auto expected = fuzz::partition_of(*batch, batch->components(), change.added);
  const auto found = fuzz::partition_of(map.engine(), map.engine().components(), live);
  const bool agrees = expected.labels == found.labels && expected.thetas == found.thetas;
  std::cout << "\nLabels and thetas of the corrected map " << (agrees ? "equal" : "DIFFER FROM")
            << " batch; the longest update took " << number(max_ms / batch_ms)
            << " times as long as batch.\n";
  return agrees;
}

}  // namespace

bool bench_corrections(const std::string& mode, const EngineConfig& config, const Slices& slices,
                       const CorrectionsConfig& corrections) {
  EditableMap map(mode, config, slices, corrections.measures_cpu);
  Random random(corrections.seed);
  print_head({mode + ", correction" + (corrections.measures_cpu ? " (CPU time)" : ""), "updates",
              "points each", "p50, ms", "p90, ms", "p99, ms", "max, ms", "us a point", "rebuilt"});
  double max_ms = move_points(map, random, corrections.num_single);
  max_ms = std::max(max_ms, remove_points(map, random, corrections.num_single / 10));
  max_ms = std::max(max_ms, move_balls(map, random));
  max_ms = std::max(max_ms, move_third(map));
  return equals_batch(map, config, corrections.measures_cpu, max_ms);
}

}  // namespace kintsugi::segmenter::bench
