// kintsugi-diff without AFTER: the map on a bus of its own against a saved one.

#include <string>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "lcmtypes/client/object_listener.hpp"
#include "tests/segmenter/objects/process/programs_on_bus.hpp"

namespace kintsugi::segmenter {
namespace {

using kintsugi::testing::ChildProgram;
using kintsugi::testing::kPrivateBusUrl;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::ToyRoom;

using DiffOnBus = testing::ProgramsOnBus;

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
  ChildProgram events = start("kintsugi-segment-events", {url_});
  ChildProgram diff =
      start("kintsugi-diff", {path("before"), "--out", path("out"), "--exit-on-final", url_});
  ChildProgram segmenter = start(
      "kintsugi-segmenter", {"--out", path("segments"), "--exit-on-final", "--linger=2", url_});
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
