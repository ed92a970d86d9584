#pragma once
// The built program on a bus of the test's own, and what it says there.

#include <chrono>
#include <csignal>
#include <filesystem>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "lcmtypes/base/patient_clock.hpp"
#include "lcmtypes/bus/bus_thread.hpp"
#include "lcmtypes/bus/message_subscriber.hpp"
#include "lcmtypes/channels.hpp"
#include "lcmtypes/stream/stream_subscriber.hpp"
#include "tests/support/child_program.hpp"
#include "tests/support/private_bus.hpp"

namespace kintsugi::mapper::testing {

class MapperProgram : public kintsugi::testing::ChildProgram {
 public:
  /// @param output for what it prints; empty: the test's own
  explicit MapperProgram(std::vector<std::string> flags, const std::string& output = {})
      : ChildProgram(path(), on_private_bus(std::move(flags)), output) {}

  void interrupt() const { signal(SIGINT); }

  /// SIGKILL; false when it had ended by itself.
  bool crash() {
    signal(SIGKILL);
    return wait() == -SIGKILL;
  }

  static std::string path() {
    const auto here = std::filesystem::read_symlink("/proc/self/exe").parent_path();
    return here.parent_path() / "bin" / "kintsugi-mapper";
  }
  static std::vector<std::string> on_private_bus(std::vector<std::string> flags) {
    flags.insert(flags.end(), {"--lcm-url", kintsugi::testing::kPrivateBusUrl});
    return flags;
  }
};

/// Whether every id from 0 to that of the final slice is there, in any order and number of
/// revisions.
inline bool ids_have_no_gap(const std::vector<CloudSlice>& slices) {
  std::set<std::int32_t> ids;
  for (const CloudSlice& slice : slices) ids.insert(slice.id);
  return !ids.empty() && *ids.begin() == 0 && *ids.rbegin() + 1 == std::ssize(ids);
}

/// Everything the mapper says, kept.
class Listener {
 public:
  Listener() : bus_(kintsugi::testing::kPrivateBusUrl) {
    kintsugi::subscribe<CameraPose>(bus_, channels::kCameraPose,
                                    [this](const CameraPose& pose) { keep(poses_, pose); });
    kintsugi::subscribe<MapperStatus>(
        bus_, channels::kMapperStatus,
        [this](const MapperStatus& status) { keep(statuses_, status); });
    slices_in_.subscribe(bus_);
    frames_in_.subscribe(bus_);
    thread_.emplace(bus_, [this] { slices_in_.ask(bus_, clock_.now_s()); });
  }

  std::vector<CameraPose> poses() const { return copy(poses_); }
  std::vector<MapperStatus> statuses() const { return copy(statuses_); }
  std::vector<CloudSlice> slices() const { return copy(slices_); }
  std::vector<RgbdFrameMessage> frames() const { return copy(frames_); }

  bool heard_the_end() const {
    const auto statuses = this->statuses();
    return !statuses.empty() && statuses.back().finished;
  }

  /// Waits, long enough for a machine that has other things to do.
  template <typename Condition>
  static bool wait_until(const Condition& condition,
                         std::chrono::milliseconds period = std::chrono::milliseconds(20)) {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::minutes(2);
    while (!condition() && std::chrono::steady_clock::now() < deadline) {
      std::this_thread::sleep_for(period);
    }
    return condition();
  }

 private:
  template <typename Message>
  void keep(std::vector<Message>& messages, Message message) {
    const std::scoped_lock lock(mutex_);
    messages.push_back(std::move(message));
  }
  template <typename Message>
  std::vector<Message> copy(const std::vector<Message>& messages) const {
    const std::scoped_lock lock(mutex_);
    return messages;
  }

  PatientClock clock_;
  mutable std::mutex mutex_;
  std::vector<CameraPose> poses_;
  std::vector<MapperStatus> statuses_;
  std::vector<CloudSlice> slices_;
  std::vector<RgbdFrameMessage> frames_;
  Bus bus_;
  StreamSubscriber<CloudSlice> slices_in_{
      channels::kCloudSlice, [this](CloudSlice slice) { keep(slices_, std::move(slice)); }};
  StreamSubscriber<RgbdFrameMessage> frames_in_{
      channels::kRgbdFrame, [this](RgbdFrameMessage frame) { keep(frames_, std::move(frame)); }};
  std::optional<BusThread> thread_;
};

}  // namespace kintsugi::mapper::testing
