// bench_large_walk STORED BUS: plays a walk at the pace at which it was made, into a map that is
// large already: level floors that are far away come first. Stands in for the mapper of the walk,
// and sends again what is asked for.

#include <Eigen/Geometry>
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <limits>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <variant>
#include <vector>

#include <CLI/CLI.hpp>

#include "lcmtypes/bus/bus.hpp"
#include "lcmtypes/bus/bus_thread.hpp"
#include "lcmtypes/bus/message_subscriber.hpp"
#include "lcmtypes/channels.hpp"
#include "lcmtypes/log/log_reader.hpp"
#include "lcmtypes/scene/up_direction.hpp"
#include "lcmtypes/stream/sent_store.hpp"
#include "lcmtypes/stream/stream_publisher.hpp"
#include "lcmtypes/stream/stream_subscriber.hpp"

namespace kintsugi {
namespace {

using Clock = std::chrono::steady_clock;
using Seconds = std::chrono::duration<double>;

constexpr int kRowPoints = 500;
constexpr int kSliceRows = 20;   // 10,000 points, as a mapper's slices have
constexpr int kFloorRows = 500;  // 20 m^2
constexpr double kSpacing_m = 0.009;
constexpr double kAway_m = 100.0;
constexpr double kApart_m = 3.0;  // between floors

struct Options {
  std::string stored;
  std::string bus;
  std::string url;
  std::int64_t points = 4'000'000;
  double rest_s = 40.0;
  double patience_s = 300.0;
};

struct Event {
  double time_s = 0.0;  // as the log has it
  std::variant<CloudSlice, CameraPose, CameraView> message;
};

/// What the mapper told, and the direction that is up in its map.
struct Walk {
  std::vector<Event> events;
  UpDirection up;
  const CloudSlice* first = nullptr;
  std::int64_t points = 0;
};

/// Slices and poses, of the log that the mapper has stored: it lacks nothing.
void read_map(const std::string& path, Walk& walk) {
  double now_s = 0.0;
  StreamSubscriber<CloudSlice> slices(channels::kCloudSlice, [&](CloudSlice slice) {
    walk.up.add(slice.points_W);
    walk.points += std::ssize(slice.points_W);
    walk.events.push_back({now_s, std::move(slice)});
  });
  LogReader log(path);
  while (const auto event = log.next()) {
    now_s = 1e-6 * static_cast<double>(event->utime);
    slices.handle(event->channel, event->data);
    if (event->channel == channels::kCameraPose) {
      walk.events.push_back({now_s, decode<CameraPose>(event->data)});
    }
  }
  if (walk.points == 0) throw std::runtime_error(path + ": has no points");
  if (slices.counts().chunks_missing > 0) throw std::runtime_error(path + ": lacks slices");
}

/// Views, which are not stored: what of them lcm-logger has received.
void read_views(const std::string& path, Walk& walk) {
  double now_s = 0.0;
  StreamSubscriber<CameraView> views(channels::kCameraView, [&](CameraView view) {
    walk.events.push_back({now_s, std::move(view)});
  });
  LogReader log(path);
  while (const auto event = log.next()) {
    now_s = 1e-6 * static_cast<double>(event->utime);
    views.handle(event->channel, event->data);
  }
}

Walk read(const Options& options) {
  Walk walk;
  read_map(options.stored, walk);
  read_views(options.bus, walk);
  std::ranges::stable_sort(walk.events, {}, &Event::time_s);
  const auto first = std::ranges::find_if(walk.events, [](const Event& event) {
    return std::holds_alternative<CloudSlice>(event.message);
  });
  walk.first = &std::get<CloudSlice>(first->message);
  return walk;
}

/// A part of a floor far below the walk.
CloudSlice floor_slice(const CloudSlice& like, const Eigen::Vector3d& up_W, std::int32_t id) {
  constexpr int kSlicesOfFloor = kFloorRows / kSliceRows;
  const Eigen::Vector3d x_W = up_W.unitOrthogonal();
  const Eigen::Vector3d y_W = up_W.cross(x_W);
  const int floor = id / kSlicesOfFloor;
  const Eigen::Vector3d corner_W = -(kAway_m + kApart_m * floor) * up_W;
  CloudSlice slice;
  slice.utime = like.utime;
  slice.session = like.session;
  slice.map_name = like.map_name;
  slice.id = id;
  slice.kind = SliceKind::kShiftPlusX;
  slice.resolution_m = like.resolution_m;
  slice.points_W.reserve(std::size_t{kRowPoints} * kSliceRows);
  for (int row = 0; row < kSliceRows; ++row) {
    const int y = id % kSlicesOfFloor * kSliceRows + row;
    for (int x = 0; x < kRowPoints; ++x) {
      const Eigen::Vector3f p_W = (corner_W + kSpacing_m * (x * x_W + y * y_W)).cast<float>();
      CloudPoint& point = slice.points_W.emplace_back();
      point.x = p_W.x();
      point.y = p_W.y();
      point.z = p_W.z();
      point.nx = static_cast<float>(up_W.x());
      point.ny = static_cast<float>(up_W.y());
      point.nz = static_cast<float>(up_W.z());
      point.red = point.green = point.blue = 120;
      point.weight = 1.0F;
    }
  }
  return slice;
}

class WalkPlayer {
 public:
  WalkPlayer(const Options& options, Walk walk)
      : options_(options),
        walk_(std::move(walk)),
        bus_(options.url),
        slices_(bus_, channels::kCloudSlice, walk_.first->session, config(), &sent_),
        views_(bus_, channels::kCameraView, walk_.first->session, config()) {
    slices_.subscribe(bus_);
    subscribe<DetectorStatus>(bus_, channels::kDetectorStatus,
                              [this](const DetectorStatus& status) {
                                points_detected_ = status.points;
                                is_finished_ = status.finished;
                              });
  }

  void run() {
    const BusThread answering(bus_);
    const std::int64_t points_of_slice = std::int64_t{kRowPoints} * kSliceRows;
    const std::int64_t missing = std::max<std::int64_t>(options_.points - walk_.points, 0);
    const auto floors = static_cast<std::int32_t>(missing / points_of_slice);
    for (std::int32_t id = 0; id < floors; ++id) {
      slices_.publish(floor_slice(*walk_.first, walk_.up.up_W(), id));
    }
    slices_.flush();
    wait_for("the floors", [&] { return points_detected_ >= floors * points_of_slice; });
    std::this_thread::sleep_for(Seconds(options_.rest_s));
    const Clock::time_point begin = Clock::now();
    for (Event& event : walk_.events) {
      std::this_thread::sleep_until(begin + std::chrono::duration_cast<Clock::duration>(Seconds(
                                                event.time_s - walk_.events.front().time_s)));
      std::visit([&](auto& message) { publish(std::move(message), floors); }, event.message);
    }
    slices_.flush();
    wait_for("the walk", [this] { return is_finished_.load(); });
  }

 private:
  StreamPublisher::Config config() const {
    StreamPublisher::Config config;
    config.max_chunk_bytes = bus_.max_message_bytes();
    config.map_name = walk_.first->map_name;
    return config;
  }

  /// The slices of the walk come after those of the floors.
  void publish(CloudSlice slice, std::int32_t floors) {
    slice.id += floors;
    for (PatchMotion& motion : slice.motions) motion.id += floors;
    slices_.publish(std::move(slice));
  }
  void publish(CameraView view, std::int32_t /*floors*/) { views_.publish(std::move(view)); }
  void publish(const CameraPose& pose, std::int32_t /*floors*/) {
    bus_.publish(channels::kCameraPose, pose);
  }

  /// For a detector.
  template <class IsThere>
  void wait_for(const std::string& what, const IsThere& is_there) const {
    const Clock::time_point begin = Clock::now();
    while (!is_there()) {
      if (Clock::now() - begin > Seconds(options_.patience_s)) {
        throw std::runtime_error("no detector has examined " + what);
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
  }

  const Options options_;
  Walk walk_;
  std::atomic<std::int64_t> points_detected_ = 0;
  std::atomic<bool> is_finished_ = false;
  Bus bus_;
  RecentChunks sent_{std::numeric_limits<std::size_t>::max()};
  StreamPublisher slices_;
  StreamPublisher views_;
};

}  // namespace
}  // namespace kintsugi

int main(int argc, char** argv) {
  using namespace kintsugi;
  Options options;
  CLI::App app(
      "Plays the slices, poses and views of a walk into a map that is large already."
      " A detector has to listen.");
  app.add_option("STORED", options.stored, "The log that the mapper has stored")->required();
  app.add_option("BUS", options.bus, "What lcm-logger has heard of the same walk")->required();
  app.add_option("--lcm-url", options.url, "The bus; empty: LCM's default");
  app.add_option("--points", options.points,
                 "Size of the map in the end, at least that of the walk")
      ->capture_default_str();
  app.add_option("--rest", options.rest_s, "Seconds between the floors and the walk")
      ->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  try {
    WalkPlayer(options, read(options)).run();
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_large_walk: %s\n", error.what());
    return 1;
  }
}
