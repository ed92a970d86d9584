// kintsugi-objects detect on a bus of its own against what it finds in the saved map.

#include <algorithm>
#include <csignal>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "lcmtypes/bus/message_subscriber.hpp"
#include "lcmtypes/client/object_listener.hpp"
#include "segmenter/core/parameters/presets.hpp"
#include "segmenter/objects/library/object_files.hpp"
#include "segmenter/objects/model/make_model.hpp"
#include "tests/segmenter/objects/process/programs_on_bus.hpp"

namespace kintsugi::segmenter {
namespace {

using kintsugi::testing::ChildProgram;
using kintsugi::testing::kPrivateBusUrl;
using nlohmann::json;
using testing::ToyRoom;

class DetectOnBus : public testing::ProgramsOnBus {
 protected:
  /// A box on the floor, as it is seen from above and from all sides.
  void teach_box() const {
    ToyRoom room;
    room.boxes = {box_at({2.0, 1.5, 0.25})};
    const std::vector<Pose> path_S = testing::walk_through(room);
    const ObservedMap map = testing::observe(room, path_S, testing::kSavedVoxel_m);
    std::vector<CloudPoint> points_W;
    for (std::size_t i = 0; i < map.points_W.size(); ++i) {
      if (map.segment_ids[i] == kFirstBox) points_W.push_back(map.points_W[i]);
    }
    const Eigen::Vector3d up_W = path_S.front().linear().row(2).transpose();
    KnownObject object;
    object.model = make_model("box", points_W, map.resolution_m, up_W).model;
    object.model.parameters = preset("objects");
    write_object(object, folder_ / "objects");
  }
  static testing::Box box_at(const Eigen::Vector3d& center_S, double yaw_rad = 0.0) {
    return {.center_S = center_S, .size_m = {0.4, 0.25, 0.5}, .yaw_rad = yaw_rad};
  }

  /// What a detector on the bus has found when the map has ended.
  json found_on_bus(Bus& bus, const std::string& name) const {
    ChildProgram detector = start(
        "kintsugi-objects",
        {"detect", "--library", path("objects"), "--json", path(name), "--exit-on-final", url_});
    EXPECT_TRUE(hears(bus, [&] { return detector.has_ended(); }));
    EXPECT_EQ(detector.wait(), 0) << text_of(path("kintsugi-objects.log"));
    return places_in(name);
  }

  json found_in_saved_map(const std::string& name) const {
    ChildProgram detector = start("kintsugi-objects", {"detect", path("map"), "--library",
                                                       path("objects"), "--json", path(name)});
    EXPECT_EQ(detector.wait(), 0) << text_of(path("kintsugi-objects.log"));
    return places_in(name);
  }

 private:
  static constexpr std::uint32_t kFirstBox = 7;

  /// Without what depends on when it was found.
  json places_in(const std::string& name) const {
    json places = json::parse(text_of(path(name))).at("detections");
    for (json& place : places) {
      for (const char* key : {"detection", "event", "utime"}) place.erase(key);
    }
    return places;
  }
};

TEST_F(DetectOnBus, FindsWhatItFindsInTheSavedMapAndItsViewsAlsoWhenItComesLate) {
  teach_box();
  ToyRoom room = testing::furnished_room();
  room.boxes.push_back(box_at({2.2, 1.8, 0.25}, 0.6));
  const ObservedMap map =
      testing::observe(room, testing::walk_through(room), testing::kSavedVoxel_m);
  Bus bus(kPrivateBusUrl);
  testing::MapperImitation mapper(bus, kSession);
  mapper.answer(bus);
  bool has_status = false;
  bus.subscribe(channels::kSegmenterStatus, [&](ByteView) { has_status = true; });
  ChildProgram segmenter =
      start("kintsugi-segmenter", {"--preset=objects", "--out", path("segments"), "--save",
                                   path("map"), "--linger=120", "--exit-on-final", url_});
  ASSERT_TRUE(hears(bus, [&] { return has_status; }));
  publish(bus, mapper, map);

  const json found = found_on_bus(bus, "found.json");
  ASSERT_EQ(found.size(), 1U) << found;
  EXPECT_EQ(found_on_bus(bus, "late.json"), found);
  segmenter.signal(SIGTERM);
  EXPECT_EQ(segmenter.wait(), 0) << text_of(path("kintsugi-segmenter.log"));

  json saved = found_in_saved_map("saved.json");
  EXPECT_EQ(saved, found);
  std::filesystem::remove(views_file_of(folder_ / "map"));
  EXPECT_NE(found_in_saved_map("without.json"), found);  // the views do tell something
}

TEST_F(DetectOnBus, TellsAProblemOfTheLibraryUntilItIsBack) {
  teach_box();
  Bus bus(kPrivateBusUrl);
  std::string problem = "no status yet";
  subscribe<DetectorStatus>(bus, channels::kDetectorStatus,
                            [&](const DetectorStatus& status) { problem = status.problem; });
  ChildProgram detector = start("kintsugi-objects", {"detect", "--library", path("objects"), url_});
  ASSERT_TRUE(hears(bus, [&] { return problem.empty(); }));
  std::filesystem::rename(folder_ / "objects", folder_ / "moved");
  std::ofstream(folder_ / "objects") << "no folder";
  ASSERT_TRUE(hears(bus, [&] { return !problem.empty(); }));
  EXPECT_THAT(problem, ::testing::HasSubstr("cannot be read as a library of objects"));
  std::filesystem::remove(folder_ / "objects");
  std::filesystem::rename(folder_ / "moved", folder_ / "objects");
  EXPECT_TRUE(hears(bus, [&] { return problem.empty(); })) << problem;
  detector.signal(SIGTERM);
  EXPECT_EQ(detector.wait(), 0) << text_of(path("kintsugi-objects.log"));
}

TEST_F(DetectOnBus, KeepsAnObjectUntilItsPatchIsSegmentedAnew) {
  teach_box();
  ToyRoom room = testing::furnished_room();
  room.boxes.push_back(box_at({2.2, 1.8, 0.25}, 0.6));
  const ObservedMap map =
      testing::observe(room, testing::walk_through(room), testing::kSavedVoxel_m);
  Bus bus(kPrivateBusUrl);
  testing::MapperImitation mapper(bus, kSession);
  mapper.answer(bus);
  std::vector<DetectionEvent> events;
  int num_statuses = 0;
  std::int64_t num_updates = 0;
  ObjectListener listener(
      "map", {.on_detection = [&](const ObjectDetection& d) { events.push_back(d.event); },
              .on_change = {}});
  listener.subscribe(bus, [] { return 0.0; });
  const auto hears_statuses = [&](int count) {
    const int since = num_statuses;
    return hears(bus, [&] { return num_statuses >= since + count; });
  };
  subscribe<DetectorStatus>(bus, channels::kDetectorStatus, [&](const DetectorStatus& status) {
    ++num_statuses;
    num_updates = status.updates_applied;
  });
  bool has_status = false;
  bus.subscribe(channels::kSegmenterStatus, [&](ByteView) { has_status = true; });
  ChildProgram segmenter =
      start("kintsugi-segmenter", {"--preset=objects", "--out", path("segments"), url_});
  ChildProgram detector =
      start("kintsugi-objects", {"detect", "--library", path("objects"), "--cpu-share=1", url_});
  ASSERT_TRUE(hears(bus, [&] { return has_status && num_statuses > 0; }));
  CloudSlice patch = testing::slice_of(map, kSession);
  patch.kind = SliceKind::kPatch;
  patch.ends_batch = true;
  mapper.publish(patch);
  ASSERT_TRUE(hears(bus, [&] { return !events.empty() && num_updates == 1; }));

  segmenter.signal(SIGSTOP);
  ++patch.revision;
  patch.utime += 1'000'000;
  patch.points_W.front().x += 0.001F;
  mapper.publish(patch);
  EXPECT_TRUE(hears_statuses(4));  // meanwhile the patch is there, and not its segments
  segmenter.signal(SIGCONT);
  EXPECT_TRUE(hears(bus, [&] { return num_updates == 2; }));
  EXPECT_TRUE(hears_statuses(2));
  EXPECT_EQ(std::ranges::count(events, DetectionEvent::kGone), 0);
  detector.signal(SIGTERM);
  EXPECT_EQ(detector.wait(), 0) << text_of(path("kintsugi-objects.log"));
}

}  // namespace
}  // namespace kintsugi::segmenter
