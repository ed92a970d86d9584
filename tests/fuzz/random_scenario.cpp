#include "tests/fuzz/random_scenario.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <utility>

#include "segmenter/core/graph/neighbour_index.hpp"
#include "segmenter/core/parameters/engine_config.hpp"
#include "tests/fuzz/random.hpp"
#include "tests/fuzz/random_cloud.hpp"
#include "tests/segmenter/core/random_clouds.hpp"

namespace kintsugi::segmenter::fuzz {
namespace {

using testing::colored_as;
using testing::make_point;

/// The paper's parameters mostly; others shift how much a size weighs against a weight, or a colour
/// against a normal. Fragments are joined mostly, from pairs of points up to all that there is.
EngineConfig random_config(Random& random) {
  EngineConfig config;
  config.resolution_m = kResolution_m;
  if (random.chance(0.3)) config.threshold = random.log_uniform(1e-4, 1e-2);
  if (random.chance(0.4)) config.scale = random.log_uniform(1e-5, 2e-1);
  if (random.chance(0.6)) config.color_weight = random.log_uniform(1e-4, 1e-1);
  if (random.chance(0.75)) config.min_points = std::floor(random.log_uniform(1.0, 500.0));
  // Always by change propagation; or the propagation is given up in the middle and rebuilds.
  if (random.chance(0.8)) config.rebuild_share = 1e9;
  if (random.chance(0.2)) {
    config.explore_share = 0.0;
    config.explore_at_least = std::floor(random.log_uniform(1.0, 300.0)) - 1.0;
  }
  return config;
}

/// Turns about the vertical axis through `centre`, then shifts.
struct RigidMotion {
  CloudPoint centre;
  double cos_yaw = 1.0;
  double sin_yaw = 0.0;
  double shift_m[3] = {};

  static RigidMotion draw(Random& random, const CloudPoint& centre) {
    const double yaw = random.uniform(-0.02, 0.02);
    RigidMotion motion{centre, std::cos(yaw), std::sin(yaw), {}};
    const double most_m = random.log_uniform(1e-4, 0.03);
    for (double& shift : motion.shift_m) shift = random.uniform(-most_m, most_m);
    return motion;
  }

  CloudPoint operator()(const CloudPoint& p) const {
    const double x = p.x - centre.x;
    const double y = p.y - centre.y;
    const CloudPoint moved =
        make_point(centre.x + cos_yaw * x - sin_yaw * y + shift_m[0],
                   centre.y + sin_yaw * x + cos_yaw * y + shift_m[1], p.z + shift_m[2],
                   cos_yaw * p.nx - sin_yaw * p.ny, sin_yaw * p.nx + cos_yaw * p.ny, p.nz);
    return colored_as(p, moved);
  }
};

class ScenarioWriter {
 public:
  ScenarioWriter(std::uint64_t seed, const ScenarioBounds& bounds,
                 std::span<const CloudPoint> map_W)
      : random_(seed) {
    scenario_.config = random_config(random_);
    const auto num_points = static_cast<std::size_t>(random_.log_uniform(
        static_cast<double>(bounds.min_points), static_cast<double>(bounds.max_points) + 1.0));
    scenario_.pool = random_cloud(random_, num_points, map_W);
    cloud_size_ = scenario_.pool.size();
    if (random_.chance(0.3)) scenario_.slice_points = random_.between(2, cloud_size_ / 4 + 2);
    is_in_.resize(cloud_size_, false);
    max_slice_ = random_.between(1, cloud_size_ / (random_.chance(0.3) ? 1 : 4) + 2);
    num_steps_ = random_.between(bounds.max_steps / 4 + 1, bounds.max_steps);
  }

  Scenario write() && {
    while (scenario_.steps.size() < num_steps_) write_step();
    return std::move(scenario_);
  }

 private:
  void write_step() {
    live_.clear();
    for (PoolIndex i = 0; i < is_in_.size(); ++i) {
      if (is_in_[i]) live_.push_back(i);
    }
    step_ = {};
    const std::size_t num_events = random_.chance(0.6) ? 1 : random_.between(2, 4);
    for (std::size_t e = 0; e < num_events; ++e) write_event();
    scenario_.steps.push_back(std::move(step_));
  }

  void write_event() {
    if (live_.empty() || random_.chance(0.3)) return add_slice();
    switch (random_.below(18)) {
      case 0:
        return remove_all({random_.pick(live_)});
      case 1:
      case 2:
        return remove_all(some_points());
      case 3:
      case 4:
        return remove_all(ball());
      case 5:
      case 6:
        return come_back();
      case 7:
        return move({random_.pick(live_)});
      case 8:
        return move(some_points());
      case 9:
        return move(ball());
      case 10:
      case 11:
        return move_rigidly();
      case 12:
      case 13:
        return move_rigidly_back();
      case 14:
        return random_.chance(0.5) ? replace_slice() : take_places_again();
      case 16:
      case 17:
        return revise_patches();
      default:
        if (random_.chance(0.2)) return remove_all(live_);
        if (random_.chance(0.5)) return take_places_twice();
    }
  }

  // What comes.

  void add_slice() {
    std::vector<PoolIndex> slice;
    for (std::size_t k = random_.below(max_slice_ + 1); k > 0 && next_ < cloud_size_; --k) {
      slice.push_back(static_cast<PoolIndex>(next_++));
    }
    for (const PoolIndex i : slice) add(i);
    if (!slice.empty()) slices_.push_back(std::move(slice));
  }

  /// Points that left return to their place, some or all.
  void come_back() {
    const bool all = random_.chance(0.3);
    for (const PoolIndex i : std::exchange(gone_, {})) {
      if (all || random_.chance(0.5)) {
        add(i);
      } else {
        gone_.push_back(i);
      }
    }
  }

  void take_places_twice() {
    for (const PoolIndex i : some_points()) add_new(scenario_.pool[i]);
  }

  // What goes.

  void remove_all(const std::vector<PoolIndex>& points) {
    for (const PoolIndex i : points) {
      if (remove(i)) gone_.push_back(i);
    }
  }

  // What moves.

  void move(const std::vector<PoolIndex>& points) {
    const double shift_m = random_.chance(0.3) ? 0.0 : 0.002;
    const double tilt = random_.log_uniform(1e-3, 5e-2);
    for (const PoolIndex i : points) {
      if (!remove(i)) continue;
      add_new(measured_again(scenario_.pool[i], shift_m, tilt));
    }
  }

  /// Points leave and come in one update, to the same places.
  void take_places_again() {
    for (const PoolIndex i : random_.chance(0.5) ? some_points() : ball()) {
      if (remove(i)) add_new(scenario_.pool[i]);
    }
  }

  void move_rigidly() {
    const std::vector<PoolIndex> piece = ball();
    const auto motion = RigidMotion::draw(random_, scenario_.pool[piece.front()]);
    Group group;
    for (const PoolIndex i : piece) {
      if (!remove(i)) continue;
      group.before.push_back(i);
      group.after.push_back(add_new(motion(scenario_.pool[i])));
    }
    displaced_.push_back(std::move(group));
  }

  void move_rigidly_back() {
    if (displaced_.empty()) return move_rigidly();
    std::swap(displaced_[random_.below(displaced_.size())], displaced_.back());
    for (const PoolIndex i : displaced_.back().after) remove(i);
    for (const PoolIndex i : displaced_.back().before) add(i);
    displaced_.pop_back();
  }

  /// A slice comes again, corrected: some of its points are gone, the others moved.
  void replace_slice() {
    if (slices_.empty()) return;
    std::vector<PoolIndex>& slice = slices_[random_.below(slices_.size())];
    const auto motion = RigidMotion::draw(random_, scenario_.pool[slice.front()]);
    std::vector<PoolIndex> replacement;
    for (const PoolIndex i : slice) {
      remove(i);
      if (!random_.chance(0.1)) replacement.push_back(add_new(motion(scenario_.pool[i])));
    }
    if (!replacement.empty()) slice = std::move(replacement);
  }

  /// A batch of patches: the points in some tiles of space are measured again. Most are somewhere
  /// else by less than a voxel, some are the same, some are gone, and some are new.
  void revise_patches() {
    const double tile_m = random_.log_uniform(0.02, 0.2);
    const auto tile_of = [&](const CloudPoint& p) {
      const auto cell = [&](float value) { return static_cast<int>(std::floor(value / tile_m)); };
      return std::array{cell(p.x), cell(p.y), cell(p.z)};
    };
    std::set<std::array<int, 3>> tiles;
    for (std::size_t k = random_.between(1, 3); k > 0; --k) {
      tiles.insert(tile_of(scenario_.pool[random_.pick(live_)]));
    }
    const double most_m = random_.log_uniform(1e-4, 0.5 * kResolution_m);
    const double tilt = random_.log_uniform(1e-4, 2e-2);
    const double share_gone = random_.chance(0.5) ? 0.0 : random_.uniform(0.0, 0.5);
    for (const PoolIndex i : live_) {
      const CloudPoint p = scenario_.pool[i];
      if (!tiles.contains(tile_of(p)) || !remove(i) || random_.chance(share_gone)) continue;
      add_new(random_.chance(0.1) ? p : measured_again(p, most_m, tilt));
      if (random_.chance(0.05)) add_new(measured_again(p, kResolution_m, tilt));
    }
  }

  CloudPoint measured_again(const CloudPoint& p, double most_m, double tilt) {
    const auto jitter = [&](double value, double most) {
      return value + random_.uniform(-most, most);
    };
    const double x = jitter(p.x, most_m);
    const double y = jitter(p.y, most_m);
    const double z = jitter(p.z, most_m);
    const double nx = jitter(p.nx, tilt);
    const double ny = jitter(p.ny, tilt);
    return colored_as(p, make_point(x, y, z, nx, ny, jitter(p.nz, tilt)));
  }

  // Which points.

  std::vector<PoolIndex> some_points() {
    std::vector<PoolIndex> points(random_.between(1, std::min<std::size_t>(20, live_.size())));
    for (PoolIndex& i : points) i = random_.pick(live_);
    return points;
  }

  /// Those around a random point, which comes first.
  std::vector<PoolIndex> ball() {
    const PoolIndex centre = random_.pick(live_);
    const auto radius_m = static_cast<float>(random_.log_uniform(0.008, 0.15));
    std::vector<PoolIndex> points = {centre};
    for (const PoolIndex i : live_) {
      if (i != centre && are_neighbours(scenario_.pool[i], scenario_.pool[centre], radius_m)) {
        points.push_back(i);
      }
    }
    return points;
  }

  void add(PoolIndex i) {
    if (is_in_[i]) return;
    is_in_[i] = true;
    step_.add.push_back(i);
  }

  /// False when the point is not in the map.
  bool remove(PoolIndex i) {
    if (!is_in_[i]) return false;
    is_in_[i] = false;
    step_.remove.push_back(i);
    return true;
  }

  PoolIndex add_new(CloudPoint p) {
    scenario_.pool.push_back(p);
    is_in_.push_back(false);
    const auto i = static_cast<PoolIndex>(is_in_.size() - 1);
    add(i);
    return i;
  }

  struct Group {
    std::vector<PoolIndex> before;
    std::vector<PoolIndex> after;
  };

  Random random_;
  Scenario scenario_;
  Step step_;
  std::size_t num_steps_ = 0;
  std::size_t cloud_size_ = 0;  ///< the part of the pool that arrives by itself
  std::size_t max_slice_ = 0;
  std::size_t next_ = 0;          ///< to arrive
  std::vector<bool> is_in_;       ///< by pool index
  std::vector<PoolIndex> live_;   ///< before the step
  std::vector<PoolIndex> gone_;   ///< may come back
  std::vector<Group> displaced_;  ///< may move back
  std::vector<std::vector<PoolIndex>> slices_;
};

}  // namespace

Scenario random_scenario(std::uint64_t seed, const ScenarioBounds& bounds,
                         std::span<const CloudPoint> map_W) {
  return ScenarioWriter(seed, bounds, map_W).write();
}

}  // namespace kintsugi::segmenter::fuzz
