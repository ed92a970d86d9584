#pragma once
// Programs about objects on a bus of the test's own, with a mapper that shows a toy room.

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "lcmtypes/bus/bus.hpp"
#include "lcmtypes/channels.hpp"
#include "lcmtypes/stream/stream_publisher.hpp"
#include "tests/segmenter/objects/saved_room.hpp"
#include "tests/segmenter/objects/toy_room.hpp"
#include "tests/segmenter/process/mapper_imitation.hpp"
#include "tests/support/child_program.hpp"
#include "tests/support/private_bus.hpp"
#include "tests/support/temporary_folder.hpp"

namespace kintsugi::segmenter::testing {

class ProgramsOnBus : public ::testing::Test {
 protected:
  static constexpr std::int64_t kSession = 5;  // of the mapper

  void SetUp() override {
    static const std::optional<std::string> why_not = kintsugi::testing::enter_private_bus();
    if (why_not) GTEST_SKIP() << *why_not;
  }

  static std::string text_of(const std::filesystem::path& file) {
    std::ostringstream text;
    text << std::ifstream(file).rdbuf();
    return text.str();
  }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  /// Its output is in path(NAME.log).
  kintsugi::testing::ChildProgram start(const std::string& name,
                                        std::vector<std::string> arguments) const {
    const auto here = std::filesystem::read_symlink("/proc/self/exe").parent_path();
    return {(here.parent_path() / "bin" / name).string(), std::move(arguments),
            path(name + ".log")};
  }

  /// Handles messages until the condition holds.
  template <class Condition>
  static bool hears(Bus& bus, const Condition& condition) {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::minutes(2);
    while (!condition() && std::chrono::steady_clock::now() < deadline) {
      bus.handle(std::chrono::milliseconds(50));
    }
    return condition();
  }

  bool waits_for(Bus& bus, const std::string& log, const std::string& text) const {
    return hears(bus, [&] { return text_of(path(log)).find(text) != std::string::npos; });
  }

  /// What a mapper publishes of the room, views first.
  static void publish(Bus& bus, MapperImitation& mapper, const ObservedMap& map) {
    StreamPublisher views(
        [&bus](const std::string& channel, ByteView message) { bus.publish(channel, message); },
        channels::kCameraView, kSession, {}, nullptr);
    for (const MapView& view : map.views) views.publish(message_of(view, kSession));
    mapper.publish(slice_of(map, kSession));
  }

  const std::string url_ = std::string("--lcm-url=") + kintsugi::testing::kPrivateBusUrl;
  kintsugi::testing::TemporaryFolder folder_;
};

}  // namespace kintsugi::segmenter::testing
