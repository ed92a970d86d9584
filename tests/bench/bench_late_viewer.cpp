// A viewer that is started when the map is complete: from the encoded chunks of all slices and of
// one full state of the segmenter to the scene and the final pictures. In memory, without a bus and
// its limited rate: only the cost of the viewer.

#include <fstream>
#include <string>

#include <benchmark/benchmark.h>
#include <malloc.h>

#include "lcmtypes/base/logger.hpp"
#include "lcmtypes/channels.hpp"
#include "lcmtypes/stream/stream_publisher.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/viewer/support/synthetic_room.hpp"
#include "viewer/process/viewer_process.hpp"
#include "viewer/receiving/receiver.hpp"

namespace kintsugi::viewer {
namespace {

struct Sent {
  std::string channel;
  Bytes message;
};

/// All chunks of both streams. Labels come before their points, because then the viewer must keep
/// them until the points arrive.
std::vector<Sent> encode_room(std::int64_t million_points) {
  constexpr double kResolution_m = 0.0088;
  constexpr double kPointsPerMetre = 18.0 / (kResolution_m * kResolution_m);
  SyntheticMap room =
      make_room(1e6 * static_cast<double>(million_points) / kPointsPerMetre, kResolution_m);
  std::vector<Sent> sent;
  const auto keep = [&](const std::string& channel, ByteView message) {
    sent.push_back({channel, Bytes(message.begin(), message.end())});
  };
  StreamPublisher::Config config;
  config.rate_bytes_per_s = 1e12;
  {
    StreamPublisher updates(keep, channels::kSegmentUpdate, room.updates[0].session, config);
    updates.publish_state(std::move(room.updates));
    updates.flush();
  }
  StreamPublisher slices(keep, channels::kCloudSlice, room.slices[0].session, config);
  for (CloudSlice& slice : room.slices) slices.publish(std::move(slice));
  slices.flush();
  return sent;
}

/// A field of /proc/self/status, MB.
double status_mb(const std::string& name) {
  std::ifstream file("/proc/self/status");
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with(name + ":")) return std::stod(line.substr(name.size() + 1)) / 1024.0;
  }
  return 0.0;
}

void join_late(benchmark::State& state) {
  spdlog::set_level(spdlog::level::warn);  // standard output is for the figures
  const std::vector<Sent> sent = encode_room(state.range(0));
  double sent_mb = 0.0;
  for (const Sent& one : sent) sent_mb += 1e-6 * static_cast<double>(one.message.size());
  const bool with_pictures = state.range(1) == 1;
  const testing::TemporaryFolder folder;
  for (auto _ : state) {
    malloc_trim(0);  // what an earlier run left would be used again, and not count
    std::ofstream("/proc/self/clear_refs") << 5;  // resets VmHWM, the peak, to VmRSS
    const double before_mb = status_mb("VmRSS");
    ViewerProcess::Config config;
    config.folder = folder.path();
    ViewerProcess viewer(
        config, {.on_picture = [](const cv::Mat3b&, const std::string&) {}, .on_forgotten = {}});
    Receiver receiver(
        {.map_name = "", .has_room = {}},
        [&](Message message) { viewer.add(std::move(message), 0.0); },
        [&](std::int64_t, const std::string& why) { state.SkipWithError(why.c_str()); });
    for (const Sent& one : sent) receiver.handle(one.channel, one.message);
    if (with_pictures) viewer.write_finals(0.0, false);
    state.counters["peak_MB"] = status_mb("VmHWM") - before_mb;
    state.counters["points"] = static_cast<double>(viewer.status().points);
    state.counters["lag"] = static_cast<double>(viewer.status().lag_slices);
  }
  state.counters["sent_MB"] = sent_mb;
}

BENCHMARK(join_late)
    ->ArgNames({"million_points", "pictures"})
    ->Args({1, 0})
    ->Args({4, 0})
    ->Args({4, 1})
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace kintsugi::viewer
