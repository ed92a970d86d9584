// kintsugi-diff without AFTER: the map on a bus of its own against a saved one.

#include <chrono>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "lcmtypes/bus/bus.hpp"
#include "lcmtypes/channels.hpp"
#include "lcmtypes/client/object_listener.hpp"
#include "lcmtypes/stream/stream_publisher.hpp"
#include "tests/segmenter/objects/saved_room.hpp"
#include "tests/segmenter/objects/toy_room.hpp"
#include "tests/segmenter/process/mapper_imitation.hpp"
#include "tests/support/child_program.hpp"
#include "tests/support/private_bus.hpp"
#include "tests/support/temporary_folder.hpp"

namespace kintsugi::segmenter {
namespace {

using kintsugi::testing::ChildProgram;
using kintsugi::testing::kPrivateBusUrl;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::ToyRoom;

constexpr std::int64_t kSession = 5;

std::string program(const std::string& name) {
  const auto here = std::filesystem::read_symlink("/proc/self/exe").parent_path();
  return (here.parent_path() / "bin" / name).string();
}

std::string text_of(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

class DiffOnBus : public ::testing::Test {
 protected:
  void SetUp() override {
    static const std::optional<std::string> why_not = kintsugi::testing::enter_private_bus();
    if (why_not) GTEST_SKIP() << *why_not;
  }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  ChildProgram start(const std::string& name, std::vector<std::string> arguments) const {
    return {program(name), std::move(arguments), path(name + ".log")};
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
  static void publish(Bus& bus, testing::MapperImitation& mapper, const ObservedMap& map) {
    StreamPublisher views(
        [&bus](const std::string& channel, ByteView message) { bus.publish(channel, message); },
        channels::kCameraView, kSession, {}, nullptr);
    for (const MapView& view : map.views) views.publish(testing::message_of(view, kSession));
    mapper.publish(testing::slice_of(map, kSession));
  }

  kintsugi::testing::TemporaryFolder folder_;
};

TEST_F(DiffOnBus, PublishesWhatHasComeAndGone) {
  ToyRoom was = testing::furnished_room();
  ToyRoom is = was;
  was.boxes.push_back({.center_S = {1.6, 1.2, 0.9}, .size_m = {0.3, 0.24, 0.3}});
  is.boxes.push_back(
      {.center_S = {2.8, 2.75, 0.7}, .size_m = {0.6, 0.3, 0.4}, .color = {9, 9, 90}});
  testing::save(was, testing::walk_through(was), folder_ / "before");
  const ObservedMap map =
      testing::observe(is, testing::walk_through(is, 1.0), testing::kSavedVoxel_m);

  Bus bus(kPrivateBusUrl);
  testing::MapperImitation mapper(bus, kSession);
  mapper.answer(bus);
  ObjectListener listener("map");
  listener.subscribe(bus, [] { return 0.0; });
  const std::string url = std::string("--lcm-url=") + kPrivateBusUrl;
  ChildProgram events = start("kintsugi-segment-events", {url});
  ChildProgram diff =
      start("kintsugi-diff", {path("before"), "--out", path("out"), "--exit-on-final", url});
  ChildProgram segmenter = start("kintsugi-segmenter",
                                 {"--out", path("segments"), "--exit-on-final", "--linger=2", url});
  ASSERT_TRUE(waits_for(bus, "kintsugi-diff.log", "follows"));
  bool has_status = false;
  bus.subscribe(channels::kSegmenterStatus, [&](ByteView) { has_status = true; });
  ASSERT_TRUE(hears(bus, [&] { return has_status; }));
  publish(bus, mapper, map);

  EXPECT_TRUE(hears(bus, [&] { return diff.has_ended(); })) << text_of(path("kintsugi-diff.log"));
  EXPECT_EQ(diff.wait(), 0) << text_of(path("kintsugi-diff.log"));
  EXPECT_TRUE(hears(bus, [&] { return listener.changes().present().size() == 2; }));
  for (const ChangeReport& report : listener.changes().present()) {
    EXPECT_EQ(report.map_session, kSession);
    EXPECT_THAT(report.before, HasSubstr("before"));
    EXPECT_EQ(report.segment_ids.empty(), report.kind == ChangeKind::kGone);
  }
  EXPECT_THAT(text_of(path("kintsugi-segment-events.log")),
              AllOf(HasSubstr("new: score"), HasSubstr("gone: score"), Not(HasSubstr("moved"))));
  const auto json = nlohmann::json::parse(text_of(folder_ / "out" / "changes.json"));
  EXPECT_EQ(json["changes"].size(), 2U);
  EXPECT_EQ(json["after"], "map");
}

}  // namespace
}  // namespace kintsugi::segmenter
