// What browsers are told of a map that changes.

#include <atomic>
#include <cmath>
#include <cstring>
#include <memory>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "viewer/web/scene/live_scene.hpp"
#include "viewer/web/scene/scene_feed.hpp"

namespace kintsugi::viewer {
namespace {

using Json = nlohmann::json;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;

constexpr std::int64_t kSession = 1'000;
constexpr float kResolution_m = 0.02F;

/// A floor of 20 x 20 points that begins at `x_m`.
CloudSlice floor_patch(std::int32_t id, float x_m, std::int32_t revision = 0) {
  CloudSlice slice;
  slice.session = kSession;
  slice.id = id;
  slice.revision = revision;
  slice.kind = SliceKind::kPatch;
  slice.utime = 1'000'000 + id;
  slice.resolution_m = kResolution_m;
  for (int i = 0; i < 400; ++i) {
    const int row = i / 20;
    CloudPoint point;
    point.x = x_m + kResolution_m * static_cast<float>(i % 20);
    point.y = 1.0F;
    point.z = kResolution_m * static_cast<float>(row);
    point.ny = -1.0F;
    slice.points_W.push_back(point);
  }
  return slice;
}

SegmentUpdate update_of(const CloudSlice& slice, std::uint32_t segment_id, std::int64_t sequence) {
  SegmentUpdate update;
  update.session = 1;
  update.sequence = sequence;
  update.map_session = kSession;
  update.slice_id = slice.id;
  update.slice_revision = slice.revision;
  update.num_slices = slice.id + 1;
  update.num_segments = segment_id;
  update.labels.assign(slice.points_W.size(), segment_id);
  update.events.push_back({SegmentEventType::kCreated, segment_id, 0});
  SegmentStatistics& statistics = update.statistics.emplace_back();
  statistics.segment_id = segment_id;
  statistics.num_points = static_cast<std::uint32_t>(slice.points_W.size());
  statistics.mean_normal_W[1] = -1.0F;
  return update;
}

class WebScene : public ::testing::Test {
 protected:
  WebScene() { state(0); }  // somebody looks

  void add(const CloudSlice& slice) { session_.use(slice, 0.0); }
  void add(const SegmentUpdate& update) {
    feed_.use(update);
    session_.use(update, 0.0);
  }
  /// A floor of one segment in each of two patches.
  void add_floors() {
    for (const std::int32_t id : {0, 1}) {
      const CloudSlice slice = floor_patch(id, 0.4F * static_cast<float>(id));
      add(slice);
      add(update_of(slice, 10U + static_cast<std::uint32_t>(id), id));
    }
  }
  /// As if half a second had passed.
  void refresh() { fresh().refresh(&session_, {}); }
  SceneFeed& fresh() {
    std::this_thread::sleep_until(last_ + std::chrono::milliseconds(510));
    last_ = std::chrono::steady_clock::now();
    return feed_;
  }
  Json state(std::uint64_t since) { return Json::parse(scene_.state(kSession, since)); }
  /// Ids of the tiles in a state.
  static std::vector<int> tiles_in(const Json& state) {
    std::vector<int> ids;
    for (const Json& tile : state["tiles"]) ids.push_back(tile[0]);
    return ids;
  }

  LiveScene scene_;
  SceneFeed feed_{scene_, {}};
  MapSession session_{kSession, 0.0};
  std::chrono::steady_clock::time_point last_;
};

TEST_F(WebScene, TellsEachTileOnce) {
  add_floors();
  refresh();
  const Json first = state(0);
  EXPECT_THAT(tiles_in(first), ElementsAre(0, 1));
  EXPECT_EQ(first["points"], 800);
  EXPECT_THAT(first["parts"], SizeIs(1));
  EXPECT_THAT(tiles_in(state(first["version"])), IsEmpty());
  EXPECT_THAT(tiles_in(Json::parse(scene_.state(77, first["version"]))), ElementsAre(0, 1))
      << "another epoch: everything";
}

TEST_F(WebScene, NewLabelsResendNoPoints) {
  add_floors();
  refresh();
  const Json before = state(0);
  SegmentUpdate update = update_of(floor_patch(1, 0.4F), 11, 2);
  update.labels.assign(400, 10);
  add(update);
  refresh();
  const Json after = state(before["version"]);
  ASSERT_THAT(tiles_in(after), ElementsAre(1));
  EXPECT_EQ(after["tiles"][0][1], before["tiles"][1][1]) << "revision of the points";
  EXPECT_NE(after["tiles"][0][2], before["tiles"][1][2]) << "revision of the labels";
  const std::string labels = scene_.blocks({{1, 0, 400}}, false);
  EXPECT_LT(labels.size(), 500U);
  std::uint32_t id = 0;
  std::memcpy(&id, labels.data() + 64, sizeof(id));
  EXPECT_EQ(id, 10U);
}

TEST_F(WebScene, ACorrectionResendsOnlyThePose) {
  add_floors();
  refresh();
  const Json before = state(0);
  CloudSlice correction;
  correction.session = kSession;
  correction.id = 2;
  correction.kind = SliceKind::kCorrection;
  correction.utime = 2'000'000;
  correction.resolution_m = kResolution_m;
  correction.correction = 1;
  PatchMotion motion;
  motion.id = 1;
  motion.X_WP.t_WP[1] = 0.25F;
  correction.motions.push_back(motion);
  add(correction);
  refresh();
  const Json after = state(before["version"]);
  ASSERT_THAT(tiles_in(after), ElementsAre(1));
  for (const int field : {1, 2, 3, 6, 7, 8, 9, 10, 11}) {
    EXPECT_EQ(after["tiles"][0][field], before["tiles"][1][field]) << field;
  }
  EXPECT_EQ(after["tiles"][0][13], 0.25);
}

TEST_F(WebScene, ANewRevisionReplacesPointsAndAnEmptyOneRemovesTheTile) {
  add_floors();
  refresh();
  const Json before = state(0);
  const CloudSlice revised = floor_patch(0, 0.1F, 1);
  add(revised);
  add(update_of(revised, 10, 2));
  CloudSlice emptied = floor_patch(1, 0.0F, 1);
  emptied.points_W.clear();
  add(emptied);
  add(update_of(emptied, 12, 3));
  refresh();
  const Json after = state(before["version"]);
  EXPECT_THAT(tiles_in(after), ElementsAre(0));
  EXPECT_EQ(after["tiles"][0][1], 1);
  EXPECT_EQ(after["removed"], Json::array({1}));
  EXPECT_THAT(scene_.blocks({{1, 0, 400}}, true), IsEmpty());
}

TEST_F(WebScene, KnowsThePlaneNeighboursAndTimelineOfASegment) {
  add_floors();
  refresh();
  const Json segments = Json::parse(scene_.segments(kSession, 0))["segments"];
  ASSERT_THAT(segments, SizeIs(2));
  EXPECT_EQ(segments[0]["id"], 10);
  EXPECT_EQ(segments[0]["planar"], true);
  EXPECT_EQ(segments[0]["plane"]["normal"], Json({0.0, -1.0, 0.0}));
  EXPECT_NEAR(segments[0]["plane"]["offset"].get<double>(), -1.0, 1e-6);
  const Json segment = Json::parse(*scene_.segment(10));
  ASSERT_THAT(segment["neighbours"], SizeIs(1));
  EXPECT_EQ(segment["neighbours"][0][0], 11);
  EXPECT_EQ(segment["timeline"]["sizes"], Json::parse("[[1, 400]]"));
  EXPECT_EQ(segment["timeline"]["events"][0][1], "created");
  EXPECT_FALSE(scene_.segment(99));
}

TEST_F(WebScene, ASegmentThatNoLongerExistsIsRemoved) {
  add_floors();
  refresh();
  const Json before = state(0);
  SegmentUpdate update = update_of(floor_patch(1, 0.4F), 10, 2);
  update.num_segments = 1;
  update.events = {{SegmentEventType::kMerged, 10, 11}};
  add(update);
  refresh();
  const Json after = Json::parse(scene_.segments(kSession, before["version"]));
  EXPECT_EQ(after["removed"], Json::array({11}));
  ASSERT_THAT(after["segments"], SizeIs(1));
  EXPECT_EQ(after["segments"][0]["id"], 10);
}

TEST_F(WebScene, KnownObjectsAreThereUntilTheyAreGone) {
  add_floors();
  ObjectDetection mug;
  mug.session = 1;
  mug.map_session = kSession;
  mug.detection = mug.num_detections = 1;
  mug.event_number = 1;
  mug.name = "mug";
  mug.X_WO.translation() = Eigen::Vector3d(0.5, 0.25, 0.125);
  mug.box_min_O[0] = -0.5F;
  mug.box_max_O[2] = 1.5F;
  session_.use(mug, 0.0);
  refresh();
  EXPECT_EQ(state(0)["objects"], Json::parse(R"([{"name": "mug", "confirmed": false,
      "t": [0.5, 0.25, 0.125], "q": [0.0, 0.0, 0.0, 1.0],
      "box_min_O": [-0.5, 0.0, 0.0], "box_max_O": [0.0, 0.0, 1.5]}])"));
  mug.event = DetectionEvent::kConfirmed;
  mug.event_number = 2;
  session_.use(mug, 0.1);
  refresh();
  EXPECT_EQ(state(0)["objects"][0]["confirmed"], true);
  mug.event = DetectionEvent::kGone;
  mug.event_number = 3;
  session_.use(mug, 0.2);
  refresh();
  EXPECT_THAT(state(0)["objects"], IsEmpty());
}

TEST_F(WebScene, ANewerMapSessionBeginsAnew) {
  add_floors();
  refresh();
  MapSession newer(kSession + 1, 0.0);
  CloudSlice slice = floor_patch(5, 0.0F);
  slice.session = kSession + 1;
  newer.use(slice, 0.0);
  fresh().refresh(&newer, {});
  const Json after = state(0);
  EXPECT_EQ(after["epoch"], kSession + 1);
  EXPECT_THAT(tiles_in(after), ElementsAre(5));
}

TEST(LiveScene, ManyMayAskWhileItChanges) {
  LiveScene scene;
  scene.begin(kSession);
  std::atomic<bool> has_ended = false;
  std::vector<std::jthread> browsers;
  for (int i = 0; i < 4; ++i) {
    browsers.emplace_back([&] {
      while (!has_ended) {
        const Json state = Json::parse(scene.state(kSession, 0));
        EXPECT_LE(state["tiles"].size(), 3U);
        EXPECT_TRUE(Json::accept(scene.segments(kSession, 0)));
        EXPECT_EQ(scene.blocks({{1, 0, 400}}, true).size() % 4, 0U);
        scene.segment(10);
        scene.path(0);
        scene.image();
      }
    });
  }
  for (std::uint32_t n = 0; n < 200; ++n) {
    const CloudSlice slice = floor_patch(static_cast<std::int32_t>(n % 3), 0.0F);
    scene::Tile tile;
    tile.id = n % 3;
    tile.resolution_m = kResolution_m;
    tile.points = std::make_shared<const scene::TilePoints>(scene::make_points(slice.points_W, n));
    tile.labels = std::make_shared<const scene::TileLabels>(
        scene::make_labels(std::vector<std::uint32_t>(400, 10 + n % 2), n));
    LiveScene::Changes changes;
    changes.header = {{"points", n}};
    changes.tiles.push_back(std::move(tile));
    changes.segments.emplace_back(10 + n % 2, nlohmann::ordered_json{{"id", 10 + n % 2}});
    if (n % 5 == 0) changes.removed_tiles.push_back(n % 3);
    scene.publish(std::move(changes));
    scene.add(update_of(slice, 10, n));
    scene.set_path(0, std::vector<float>(n, 1.0F));
    scene.set_image(std::vector<std::uint8_t>(n, 1));
    if (n == 100) scene.begin(kSession + 1);
  }
  has_ended = true;
}

TEST(SceneFeed, DoesNothingWhileNobodyLooks) {
  LiveScene scene;
  SceneFeed feed(scene, {});
  MapSession session(kSession, 0.0);
  session.use(floor_patch(0, 0.0F), 0.0);
  feed.refresh(&session, {});
  EXPECT_FALSE(scene.is_watched());
  EXPECT_THAT(scene.blocks({{0, 0, 400}}, true), IsEmpty());
}

TEST(SegmentPlanes, ASphereIsNotPlanarAndAMovedFloorIs) {
  SegmentPlanes planes;
  std::vector<CloudPoint> points;
  for (int i = 0; i < 2000; ++i) {
    const double z = 1.0 - (2.0 * i + 1.0) / 2000.0;
    const double angle = 2.399963 * i;  // the golden angle: points evenly on a sphere
    const double r = 0.2 * std::sqrt(1.0 - z * z);
    CloudPoint point;
    point.x = static_cast<float>(r * std::cos(angle));
    point.y = static_cast<float>(r * std::sin(angle));
    point.z = static_cast<float>(0.2 * z);
    points.push_back(point);
  }
  scene::Tile tile;
  tile.points = std::make_shared<const scene::TilePoints>(scene::make_points(points, 0));
  tile.labels = std::make_shared<const scene::TileLabels>(
      scene::make_labels(std::vector<std::uint32_t>(points.size(), 3), 0));
  planes.set(tile);
  EXPECT_FALSE(planes.plane(3, Eigen::Vector3d::UnitZ(), 0.02).is_planar);
  EXPECT_NEAR(planes.plane(3, Eigen::Vector3d::UnitZ(), 0.02).rms_m, 0.2 / std::sqrt(3.0), 1e-3);

  const CloudSlice floor = floor_patch(0, 0.0F);
  tile.points = std::make_shared<const scene::TilePoints>(scene::make_points(floor.points_W, 1));
  tile.labels = std::make_shared<const scene::TileLabels>(
      scene::make_labels(std::vector<std::uint32_t>(400, 3), 1));
  tile.X_WP.t_WP[1] = 1.0F;
  planes.set(tile);  // instead of the sphere
  const auto plane = planes.plane(3, -Eigen::Vector3d::UnitY(), 0.02);
  EXPECT_TRUE(plane.is_planar);
  EXPECT_NEAR(plane.offset_m, -2.0, 1e-6);
  planes.remove(0);
  EXPECT_TRUE(planes.plane(3, -Eigen::Vector3d::UnitY(), 0.02).normal_W.isZero());
}

}  // namespace
}  // namespace kintsugi::viewer
