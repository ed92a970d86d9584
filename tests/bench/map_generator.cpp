#include "tests/bench/map_generator.hpp"

#include <cmath>
#include <map>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>

#include <oneapi/tbb/parallel_for.h>

#include "tests/bench/map_generator_field.hpp"
#include "tests/bench/map_generator_scene.hpp"

namespace kintsugi::segmenter::bench {
namespace {

constexpr std::size_t kMaxSlicePoints = 9000;

/// A block that leaves the cube, and how many times it left before.
struct Leaving {
  Block block;
  int visit;
};

/// The moving cube of blocks; its height is constant.
class MovingCube {
 public:
  /// Moves the cube to the column of blocks (x, y); returns the blocks that leave, in a fixed
  /// order.
  std::vector<Leaving> move_to(int x, int y) {
    if (std::pair(x, y) == centre_) return {};
    centre_ = {x, y};
    std::vector<Leaving> leaving;
    std::erase_if(columns_, [&](const Column& column) {
      const bool stays =
          std::abs(column.first - x) <= kHalf && std::abs(column.second - y) <= kHalf;
      if (!stays) leave(column, leaving);
      return !stays;
    });
    for (int dx = -kHalf; dx <= kHalf; ++dx) {
      for (int dy = -kHalf; dy <= kHalf; ++dy) columns_.insert({x + dx, y + dy});
    }
    return leaving;
  }

 private:
  using Column = std::pair<int, int>;
  static constexpr int kHalf = 9;  // blocks on each side of the centre
  static constexpr int kBottom = -2;
  static constexpr int kTop = 33;

  void leave(const Column& column, std::vector<Leaving>& leaving) {
    const int visit = visits_[column]++;
    for (int z = kBottom; z < kTop; ++z) {
      leaving.push_back({{column.first, column.second, z}, visit});
    }
  }

  Column centre_ = {1 << 20, 0};
  std::set<Column> columns_;
  std::map<Column, int> visits_;
};

class MapWriter {
 public:
  explicit MapWriter(const MapConfig& config)
      : config_(config),
        scene_(make_building(config.num_rooms, config.seed)),
        field_(scene_, config.noise, config.seed) {}

  Slices write() && {
    const auto corners = walk_through(config_.num_rooms);
    for (std::size_t k = 0; num_points_ < config_.num_points; ++k) {
      walk(corners[k % corners.size()], corners[(k + 1) % corners.size()]);
    }
    return std::move(slices_);
  }

 private:
  void walk(const std::array<double, 2>& from, const std::array<double, 2>& to) {
    constexpr double kStep_m = 0.02;
    const double length_m = std::hypot(to[0] - from[0], to[1] - from[1]);
    const int num_steps = std::max(1, static_cast<int>(length_m / kStep_m));
    for (int s = 0; s < num_steps && num_points_ < config_.num_points; ++s) {
      const double t = static_cast<double>(s) / num_steps;
      const auto block_at = [&](int axis) {
        const double p_m = from[axis] + t * (to[axis] - from[axis]);
        return static_cast<int>(std::floor(p_m / kBlock_m));
      };
      add_slices(cube_.move_to(block_at(0), block_at(1)));
    }
  }

  void add_slices(const std::vector<Leaving>& leaving) {
    std::vector<std::vector<CloudPoint>> surfaces(leaving.size());
    oneapi::tbb::parallel_for(std::size_t{0}, leaving.size(), [&](std::size_t k) {
      surfaces[k] = field_.surface_W(leaving[k].block, leaving[k].visit);
    });
    std::vector<CloudPoint> slice;
    const auto finish = [&] {
      if (slice.empty()) return;
      num_points_ += slice.size();
      slices_.push_back(std::exchange(slice, {}));
    };
    for (const auto& surface : surfaces) {
      if (slice.size() + surface.size() > kMaxSlicePoints) finish();
      slice.insert(slice.end(), surface.begin(), surface.end());
    }
    finish();
  }

  MapConfig config_;
  synthetic::Scene scene_;
  NoisyField field_;
  MovingCube cube_;
  Slices slices_;
  std::size_t num_points_ = 0;
};

void require(bool condition, const char* field, double value, const char* bound) {
  if (condition) return;
  throw std::invalid_argument(std::string(field) + " is " + std::to_string(value) + ", must be " +
                              bound);
}

}  // namespace

Slices generate_map(const MapConfig& config) {
  require(config.num_points >= 1, "num_points", 0.0, ">= 1");
  require(config.num_rooms >= 1, "num_rooms", config.num_rooms, ">= 1");
  require(config.noise >= 0.0, "noise", config.noise, ">= 0");
  return MapWriter(config).write();
}

}  // namespace kintsugi::segmenter::bench
