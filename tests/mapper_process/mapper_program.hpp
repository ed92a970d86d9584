#pragma once
// The built program on a bus of the test's own, and what it says there.

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include "lcmtypes/bus_thread.hpp"
#include "lcmtypes/channels.hpp"
#include "lcmtypes/message_subscriber.hpp"
#include "lcmtypes/patient_clock.hpp"
#include "lcmtypes/stream_subscriber.hpp"
#include "tests/support/private_bus.hpp"

namespace kintsugi::mapper::testing {

class MapperProgram {
 public:
  /// @param output for what it prints; empty: the test's own
  explicit MapperProgram(std::vector<std::string> flags, const std::string& output = {}) {
    const auto here = std::filesystem::read_symlink("/proc/self/exe").parent_path();
    flags.insert(flags.begin(), here.parent_path() / "bin" / "kintsugi-mapper");
    flags.insert(flags.end(), {"--lcm-url", kintsugi::testing::kPrivateBusUrl});
    std::vector<char*> argv;
    argv.reserve(flags.size() + 1);
    for (std::string& flag : flags) argv.push_back(flag.data());
    argv.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    if (!output.empty()) {
      posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, output.c_str(),
                                       O_WRONLY | O_CREAT | O_TRUNC, 0666);
      posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
    }
    if (posix_spawn(&pid_, argv[0], &actions, nullptr, argv.data(), environ) != 0) pid_ = -1;
    posix_spawn_file_actions_destroy(&actions);
  }
  ~MapperProgram() {
    if (pid_ > 0) {
      kill(pid_, SIGKILL);
      waitpid(pid_, nullptr, 0);
    }
  }
  MapperProgram(const MapperProgram&) = delete;
  MapperProgram& operator=(const MapperProgram&) = delete;

  void interrupt() const { kill(pid_, SIGINT); }

  /// SIGKILL; false when it had ended by itself.
  bool crash() {
    kill(pid_, SIGKILL);
    return wait() == -1;
  }

  /// Its exit code; -1 if a signal ended it.
  int wait() {
    int status = 0;
    waitpid(pid_, &status, 0);
    pid_ = -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

 private:
  pid_t pid_ = -1;
};

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
  static bool wait_until(const Condition& condition) {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::minutes(2);
    while (!condition() && std::chrono::steady_clock::now() < deadline) {
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
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
