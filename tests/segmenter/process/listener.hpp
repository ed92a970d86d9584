#pragma once
// A segmenter process on a private bus, and what is heard of it.

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include <gtest/gtest.h>

#include "lcmtypes/base/stop_signal.hpp"
#include "lcmtypes/bus/message_subscriber.hpp"
#include "lcmtypes/channels.hpp"
#include "segmenter/io/ply/ply_reader.hpp"
#include "segmenter/process/segmenter_process.hpp"
#include "tests/segmenter/process/slice_session.hpp"
#include "tests/support/private_bus.hpp"
#include "tests/support/temporary_folder.hpp"

namespace kintsugi::segmenter::testing {

inline Labels labels_in(const std::filesystem::path& ply) {
  const PlyCloud cloud = read_ply(ply);
  Labels labels;
  for (std::size_t i = 0; i < cloud.points_W.size(); ++i) {
    labels[cloud.slice_ids[i]].push_back(cloud.segment_ids[i]);
  }
  return labels;
}

// A segmenter on the bus, and everything a listener hears of it.
class Listener {
 public:
  explicit Listener(const SegmenterProcess::Config& config)
      : process_(config),
        bus_(kintsugi::testing::kPrivateBusUrl),
        updates_(channels::kSegmentUpdate, [this](SegmentUpdate update) {
          mirrors[update.map_session].apply(update);
          last = std::move(update);
        }) {
    updates_.subscribe(bus_);
    subscribe<SegmenterStatus>(bus_, channels::kSegmenterStatus, [this](const SegmenterStatus& s) {
      status = s;
      max_queue_bytes = std::max(max_queue_bytes, s.queue_bytes);
    });
    segmenter_ = std::thread([this] { exit_code_ = process_.run(); });
    // The first status tells that the segmenter listens.
    EXPECT_TRUE(hears([&] { return status.has_value(); }));
  }
  ~Listener() {
    if (segmenter_.joinable()) {
      request_stop();
      segmenter_.join();
    }
  }

  Bus& bus() { return bus_; }

  template <class Condition>
  bool hears(const Condition& condition) {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::minutes(2);
    while (!condition() && std::chrono::steady_clock::now() < deadline) {
      bus_.handle(std::chrono::milliseconds(100));
    }
    return condition();
  }

  int hear_the_end() {
    if (!hears([&] { return last && last->is_final && status && status->finished; })) {
      ADD_FAILURE() << "the segmenter does not end";
      request_stop();
    }
    segmenter_.join();
    return exit_code_;
  }

  /// Of the map that was heard of last.
  const LabelMirror& mirror() const { return mirrors.at(last->map_session); }

  std::map<std::int64_t, LabelMirror> mirrors;  // by mapper session
  std::optional<SegmentUpdate> last;
  std::optional<SegmenterStatus> status;
  std::int64_t max_queue_bytes = 0;  // of any status

 private:
  SegmenterProcess process_;
  Bus bus_;
  StreamSubscriber<SegmentUpdate> updates_;
  int exit_code_ = -1;
  std::thread segmenter_;
};

inline SegmenterProcess::Config on_the_bus(const kintsugi::testing::TemporaryFolder& folder,
                                           const std::string& mode) {
  SegmenterProcess::Config config;
  config.lcm_url = kintsugi::testing::kPrivateBusUrl;
  config.segmentation.files.folder = folder.path();
  config.exit_on_final = true;
  config.segmentation.maps.map.mode = mode;
  config.linger_s = 0.0;
  return config;
}

}  // namespace kintsugi::segmenter::testing
