#include <algorithm>
#include <cstdint>
#include <memory>
#include <random>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>

#include "segmenter/objects/detection/detector.hpp"
#include "segmenter/objects/model/make_model.hpp"
#include "tests/segmenter/objects/box_on_table.hpp"
#include "tests/segmenter/objects/toy_room.hpp"

namespace kintsugi::segmenter {
namespace {

using testing::box_on_table;
using ::testing::ElementsAre;
using testing::kBall;
using testing::kBox;
using testing::kTable;
using testing::MapOfThings;

constexpr std::int64_t kSecond_us = 1'000'000;

std::vector<CloudPoint> points_of(const ObservedMap& map, std::uint32_t id) {
  std::vector<CloudPoint> points_W;
  for (std::size_t i = 0; i < map.points_W.size(); ++i) {
    if (map.segment_ids[i] == id) points_W.push_back(map.points_W[i]);
  }
  return points_W;
}

std::vector<ObjectModel> box_and_ball() {
  const ObservedMap map = box_on_table();
  std::vector<ObjectModel> models;
  for (const auto& [id, name] : {std::pair(kBall, "ball"), std::pair(kBox, "box")}) {
    models.push_back(
        make_model(name, points_of(map, id), map.resolution_m, -Eigen::Vector3d::UnitY()).model);
  }
  return models;
}

constexpr std::uint32_t kTower = 4;

/// A third thing on the table: what the light of a place is told by.
ObservedMap three_things() {
  MapOfThings things;
  things.add_box({-0.35F, 0.3F, 0.0F}, 0.0F, {0.1F, 0.12F, 0.3F}, {"z", "-y", "x"}, kTower);
  const ObservedMap tower = things.take();
  ObservedMap all = box_on_table();
  all.points_W.insert(all.points_W.end(), tower.points_W.begin(), tower.points_W.end());
  all.segment_ids.insert(all.segment_ids.end(), tower.segment_ids.begin(), tower.segment_ids.end());
  return all;
}

std::vector<ObjectModel> box_ball_and_tower() {
  const ObservedMap map = three_things();
  std::vector<ObjectModel> models = box_and_ball();
  models.push_back(
      make_model("tower", points_of(map, kTower), map.resolution_m, -Eigen::Vector3d::UnitY())
          .model);
  return models;
}

/// Gives the detector the map as one piece of each segment.
void give(Detector& detector, const ObservedMap& map, std::int64_t utime,
          const std::vector<std::uint32_t>& segments = {kTable, kBox, kBall}) {
  for (const std::uint32_t id : segments) {
    const std::vector<CloudPoint> points_W = points_of(map, id);
    const std::vector<std::uint32_t> labels(points_W.size(), id);
    detector.set_piece(static_cast<std::int32_t>(id),
                       std::make_shared<const std::vector<CloudPoint>>(points_W), labels, utime);
  }
}

void take_away(Detector& detector, std::uint32_t id, std::int64_t utime) {
  detector.set_piece(static_cast<std::int32_t>(id),
                     std::make_shared<const std::vector<CloudPoint>>(), {}, utime);
}

void examine(Detector& detector) {
  while (detector.num_waiting() > 0) detector.examine_next();
}

std::vector<std::string> names_of(const Detector& detector) {
  std::vector<std::string> names;
  for (const Detection& detection : detector.detections()) {
    if (detection.event == DetectionEvent::kGone) continue;
    names.push_back(detector.model(detection.recognition.model).name);
  }
  std::sort(names.begin(), names.end());
  return names;
}

const Detection& detection_of(const Detector& detector, const std::string& name) {
  const auto at = std::ranges::find_if(detector.detections(), [&](const Detection& detection) {
    return detector.model(detection.recognition.model).name == name;
  });
  if (at == detector.detections().end()) throw std::runtime_error("no detection of " + name);
  return *at;
}

TEST(LabelledMap, TellsWhichSegmentsChange) {
  const ObservedMap map = box_on_table();
  LabelledMap labelled(0.2F);
  const auto points = std::make_shared<const std::vector<CloudPoint>>(map.points_W);
  const LabelledMap::Change first = labelled.set_piece(1, points, map.segment_ids);
  EXPECT_THAT(first.segments, ElementsAre(kTable, kBox, kBall));
  EXPECT_FALSE(first.blocks.empty());
  EXPECT_EQ(first.labelled_blocks, first.blocks);
  const LabelledMap::Change same = labelled.set_piece(1, points, map.segment_ids);
  EXPECT_TRUE(same.segments.empty());
  EXPECT_TRUE(same.blocks.empty());
  EXPECT_TRUE(same.labelled_blocks.empty());
  std::vector<std::uint32_t> joined = map.segment_ids;
  std::replace(joined.begin(), joined.end(), kBall, kTable);
  const LabelledMap::Change labels = labelled.set_piece(1, points, joined);
  EXPECT_THAT(labels.segments, ElementsAre(kTable, kBall));
  EXPECT_TRUE(labels.blocks.empty());
  std::set<BlockKey> blocks_of_table = labelled.blocks_of(kTable);
  EXPECT_EQ(labels.labelled_blocks, blocks_of_table);
  // The table has another point; the box and the ball are as they were, but further back.
  auto longer = std::make_shared<std::vector<CloudPoint>>(map.points_W);
  longer->insert(longer->begin(), longer->front());
  std::vector<std::uint32_t> longer_ids = joined;
  longer_ids.insert(longer_ids.begin(), kTable);
  const LabelledMap::Change grown = labelled.set_piece(1, longer, longer_ids);
  EXPECT_THAT(grown.segments, ElementsAre(kTable));
  EXPECT_FALSE(grown.blocks.empty());
  auto moved = std::make_shared<std::vector<CloudPoint>>(map.points_W);
  moved->at(static_cast<std::size_t>(std::ranges::find(joined, kBox) - joined.begin())).x += 0.001F;
  EXPECT_THAT(labelled.set_piece(1, moved, joined).segments, ElementsAre(kTable, kBox));
  labelled.set_piece(1, points, joined);
  EXPECT_EQ(labelled.num_points(kBall), 0);
  EXPECT_EQ(labelled.num_points(), static_cast<std::int64_t>(map.points_W.size()));
  EXPECT_TRUE(labelled.box_of(kBall).isEmpty());
  EXPECT_THROW(labelled.set_piece(2, points, {1, 2}), std::invalid_argument);
}

TEST(Candidates, GrowByNeighboursAndNotBeyondTheLargestObject) {
  const ObservedMap map = box_on_table();
  LabelledMap labelled(0.2F);
  labelled.set_piece(1, std::make_shared<const std::vector<CloudPoint>>(map.points_W),
                     map.segment_ids);
  const std::vector<SegmentNeighbour> of_box{{kTable, 40}};
  const std::vector<SegmentNeighbour> of_table{{kBox, 40}, {kBall, 10}};
  const NeighboursOf neighbours = [&](std::uint32_t id) -> const std::vector<SegmentNeighbour>& {
    return id == kTable ? of_table : of_box;
  };
  EXPECT_THAT(candidates_of(kBox, labelled, neighbours, 0.5F), ElementsAre(Candidate{kBox}));
  EXPECT_THAT(
      candidates_of(kBox, labelled, neighbours, 3.0F),
      ElementsAre(Candidate{kBox}, Candidate{kTable, kBox}, Candidate{kTable, kBox, kBall}));
  EXPECT_TRUE(candidates_of(kTable, labelled, neighbours, 0.5F).empty());
  EXPECT_TRUE(candidates_of(99, labelled, neighbours, 3.0F).empty());
}

TEST(Candidates, DoNotGrowByWhatIsGone) {
  const ObservedMap map = box_on_table();
  LabelledMap labelled(0.2F);
  labelled.set_piece(1, std::make_shared<const std::vector<CloudPoint>>(map.points_W),
                     map.segment_ids);
  constexpr std::uint32_t kNone = 99;
  const std::vector<SegmentNeighbour> of_box{{kTable, 40}, {kNone, 80}};
  const std::vector<SegmentNeighbour> of_others;
  const NeighboursOf neighbours = [&](std::uint32_t id) -> const std::vector<SegmentNeighbour>& {
    return id == kBox ? of_box : of_others;
  };
  EXPECT_THAT(candidates_of(kBox, labelled, neighbours, 3.0F),
              ElementsAre(Candidate{kBox}, Candidate{kTable, kBox}));
}

TEST(Recognitions, KnowTheNeighboursOfWhatDidNotChangeItself) {
  MapOfThings things;
  std::vector<std::uint32_t> joined;  // the middle one becomes part of the last one
  for (std::uint32_t id = 1; id <= 3; ++id) {
    things.add_face({0.1F * static_cast<float>(id), 0, 0}, {0.1F, 0, 0}, {0, 0.1F, 0},
                    {150, 140, 130}, id);
  }
  const ObservedMap map = things.take();
  joined = map.segment_ids;
  std::ranges::replace(joined, 2U, 3U);
  const auto points = std::make_shared<const std::vector<CloudPoint>>(map.points_W);
  const ObjectRecognizer recognizer(box_and_ball(), map.resolution_m);
  Scene scene(map.resolution_m);
  Recognitions recognitions(recognizer, scene, 0);
  scene.set_piece(1, points, map.segment_ids);
  const std::uint32_t first = 1;
  recognitions.examine(std::span(&first, 1));
  EXPECT_EQ(recognitions.num_candidates(), 3);  // 1, 1 + 2, 1 + 2 + 3
  scene.set_piece(1, points, joined);
  recognitions.forget_candidates();
  recognitions.examine(std::span(&first, 1));
  EXPECT_EQ(recognitions.num_candidates(), 5);  // 1, 1 + 3
}

TEST(Recognitions, HaveOneOfEachObjectAtASegment) {
  const ObjectRecognizer recognizer(box_and_ball(), 0.01F);
  const Scene scene(0.01F);
  Recognitions recognitions(recognizer, scene, 0);
  Recognition recognition;
  recognition.placement.segment_ids = {5, 6};
  recognition.placement.seen = 1.0F;
  recognition.placement.explained = 0.9F;
  recognitions.add(recognition);
  recognition.placement.explained = 0.8F;  // less of it is there now
  recognitions.add(recognition);
  ASSERT_EQ(recognitions.best().size(), 1U);
  EXPECT_EQ(recognitions.best()[0].placement.explained, 0.8F);
}

// With the light of now: what was followed has been compared with that of then.
TEST(Recognitions, TellTheLightOfWhatIsFollowed) {
  const ObjectRecognizer recognizer(box_and_ball(), 0.01F);
  const Scene scene(0.01F);
  Recognitions recognitions(recognizer, scene, 0);
  const auto set = [&](std::uint32_t segment, float log_gain, float explained, float agreement) {
    Recognition recognition;
    recognition.placement.segment_ids = {segment};
    recognition.placement.seen = 1.0F;
    recognition.placement.explained = explained;
    recognition.placement.light.log_gain.setConstant(log_gain);
    recognition.placement.light_agreement = agreement;
    recognitions.set(segment, recognition);
  };
  for (const std::uint32_t segment : {1, 2, 3}) set(segment, -0.5F, 0.7F, 1.0F);
  for (const std::uint32_t segment : {4, 5, 6}) set(segment, 0.5F, 1.0F, 0.5F);
  EXPECT_NEAR(recognitions.light_of(0).log_gain.mean(), 0.5F, 1e-3F);
}

TEST(Detector, FindsTheObjectsOfAMapAndConfirmsThem) {
  Detector detector(box_and_ball(), 0.01F);
  give(detector, box_on_table(), kSecond_us);
  examine(detector);
  EXPECT_THAT(names_of(detector), ElementsAre("ball", "box"));
  for (const Detection& detection : detector.detections()) {
    EXPECT_EQ(detection.event, DetectionEvent::kConfirmed);
  }
  EXPECT_EQ(detector.num_events(), 4);  // found and confirmed, twice
}

TEST(Detector, KeepsTheNumberOfAnObjectThatComesIntoViewBitByBit) {
  Detector detector(box_and_ball(), 0.01F);
  give(detector, box_on_table({"z", "-y"}), kSecond_us);
  examine(detector);
  ASSERT_THAT(names_of(detector), ElementsAre("ball", "box"));
  const std::int32_t number = detection_of(detector, "box").number;
  const std::int64_t num_changes = detector.num_changes();
  const std::int64_t num_events = detector.num_events();
  give(detector, box_on_table(), 2 * kSecond_us);
  examine(detector);
  EXPECT_EQ(detector.detections().size(), 2U);
  EXPECT_EQ(detection_of(detector, "box").number, number);
  EXPECT_GT(detection_of(detector, "box").recognition.placement.seen, 0.85F);
  // The better pose is told, though nothing has happened to the box.
  EXPECT_GT(detector.num_changes(), num_changes);
  EXPECT_EQ(detector.num_events(), num_events);
}

TEST(Detector, SearchesAgainOnlyWhenMuchMoreIsKnown) {
  Detector detector(box_and_ball(), 0.01F);
  const std::vector<CloudPoint> whole_W = points_of(box_on_table(), kBox);
  const auto give_box = [&](double share, std::int64_t utime) {
    std::vector<CloudPoint> points_W = whole_W;
    std::ranges::sort(points_W, {}, &CloudPoint::x);
    points_W.resize(
        static_cast<std::size_t>(std::min(share, 1.0) * static_cast<double>(points_W.size())));
    if (share > 1.0) points_W.insert(points_W.end(), whole_W.begin(), whole_W.end());
    const std::vector<std::uint32_t> labels(points_W.size(), kBox);
    detector.set_piece(kBox, std::make_shared<const std::vector<CloudPoint>>(points_W), labels,
                       utime);
  };
  give(detector, box_on_table(), kSecond_us, {kTable, kBall});
  give_box(0.6, kSecond_us);
  examine(detector);
  ASSERT_THAT(names_of(detector), ElementsAre("ball", "box"));
  const float seen = detection_of(detector, "box").recognition.placement.seen;
  const std::int64_t num_searched = detector.num_candidates();
  give_box(0.8, 2 * kSecond_us);
  examine(detector);
  EXPECT_EQ(detector.num_candidates(), num_searched);
  EXPECT_GT(detection_of(detector, "box").recognition.placement.seen, 1.2F * seen);
  give_box(2.0, 3 * kSecond_us);
  examine(detector);
  EXPECT_GT(detector.num_candidates(), num_searched);
  EXPECT_GT(detection_of(detector, "box").recognition.placement.seen, 0.85F);
  EXPECT_THAT(names_of(detector), ElementsAre("ball", "box"));
}

TEST(Detector, TellsWhenAnObjectIsGoneAndWhenItComesBackElsewhere) {
  Detector detector(box_and_ball(), 0.01F);
  give(detector, box_on_table(), kSecond_us);
  examine(detector);
  take_away(detector, kBox, 5 * kSecond_us);
  examine(detector);
  EXPECT_THAT(names_of(detector), ElementsAre("ball"));
  const Detection gone = detection_of(detector, "box");
  EXPECT_EQ(gone.event, DetectionEvent::kGone);
  EXPECT_EQ(gone.event_utime, 5 * kSecond_us);

  give(detector, box_on_table({"z", "-y", "x"}, {-0.3F, 0.2F, 0.0F}, 0.5F), 9 * kSecond_us, {kBox});
  examine(detector);
  const Detection& moved = detection_of(detector, "box");
  EXPECT_EQ(moved.event, DetectionEvent::kMoved);
  EXPECT_EQ(moved.number, gone.number);
  EXPECT_GT((moved.recognition.placement.X_WO.translation() -
             gone.recognition.placement.X_WO.translation())
                .norm(),
            0.3);
}

TEST(Detector, DoesNotCallMovedWhatComesBackWhereItWas) {
  Detector detector(box_and_ball(), 0.01F);
  give(detector, box_on_table(), kSecond_us);
  examine(detector);
  const std::int32_t number = detection_of(detector, "box").number;
  take_away(detector, kBox, 5 * kSecond_us);
  examine(detector);
  ASSERT_EQ(detection_of(detector, "box").event, DetectionEvent::kGone);
  const std::int64_t num_events = detector.num_events();
  give(detector, box_on_table(), 9 * kSecond_us, {kBox});
  examine(detector);
  EXPECT_EQ(detector.detections().size(), 2U);
  EXPECT_EQ(detection_of(detector, "box").number, number);
  EXPECT_EQ(detection_of(detector, "box").event, DetectionEvent::kConfirmed);
  EXPECT_EQ(detector.num_events(), num_events + 2);  // found and confirmed
}

TEST(Detector, KeepsWhatIsCutIntoSegmentsTooSmallToRecognise) {
  Detector detector(box_and_ball(), 0.01F);
  const ObservedMap map = box_on_table();
  give(detector, map, kSecond_us);
  examine(detector);
  const std::int32_t number = detection_of(detector, "box").number;
  const std::int64_t num_events = detector.num_events();

  const std::vector<CloudPoint> points_W = points_of(map, kBox);
  std::vector<std::uint32_t> labels(points_W.size());
  for (std::size_t i = 0; i < labels.size(); ++i) {
    constexpr std::uint32_t kFirst = 100;
    constexpr std::size_t kPoints = 20;
    labels[i] = kFirst + static_cast<std::uint32_t>(i / kPoints);
  }
  ASSERT_GT(labels.back(), 110U);
  const auto points = std::make_shared<const std::vector<CloudPoint>>(points_W);
  detector.set_piece(kBox, points, labels, 2 * kSecond_us);
  examine(detector);
  EXPECT_EQ(detector.num_events(), num_events);
  EXPECT_EQ(detection_of(detector, "box").number, number);
  EXPECT_GT(detection_of(detector, "box").recognition.placement.segment_ids.size(), 10U);

  take_away(detector, kBox, 3 * kSecond_us);
  examine(detector);
  EXPECT_EQ(detection_of(detector, "box").event, DetectionEvent::kGone);
}

TEST(Detector, EndsWithTheSameDetectionsWhateverTheOrder) {
  const ObservedMap map = box_on_table();
  std::vector<std::vector<Pose>> poses;
  for (const unsigned seed : {1U, 2U, 3U}) {
    Detector detector(box_and_ball(), 0.01F);
    std::vector<std::uint32_t> order{kTable, kBox, kBall};
    std::shuffle(order.begin(), order.end(), std::mt19937(seed));
    for (const std::uint32_t id : order) {
      give(detector, map, kSecond_us, {id});
      if (seed != 2) examine(detector);
    }
    detector.examine_all();
    examine(detector);
    std::vector<Pose>& of = poses.emplace_back();
    for (const char* name : {"ball", "box"}) {
      of.push_back(detection_of(detector, name).recognition.placement.X_WO);
    }
  }
  for (const std::vector<Pose>& of : poses) {
    for (std::size_t i = 0; i < of.size(); ++i) {
      EXPECT_EQ(of[i].matrix(), poses[0][i].matrix());
    }
  }
}

/// A lamp: linear red, green and blue times 1.24, 0.89, 0.89.
void make_orange(ObservedMap& map) { testing::relight(map, 1.10, 0.95, 0.95); }

TEST(Detector, ComparesColoursInTheLightThatMostObjectsTell) {
  ObservedMap map = three_things();
  testing::relight(map, 0.96, 0.92, 0.88);
  const auto largest_change = [](const Detector& detector) {
    float largest = 0.0F;
    for (const Detection& detection : detector.detections()) {
      largest = std::max(largest, detection.recognition.placement.light.log_gain.norm());
    }
    return largest;
  };
  Detector detector(box_ball_and_tower(), 0.01F);
  give(detector, map, kSecond_us);
  examine(detector);
  EXPECT_THAT(names_of(detector), ElementsAre("ball", "box"));
  EXPECT_GT(largest_change(detector), 0.2F);  // two things do not tell the light of a place

  give(detector, map, 2 * kSecond_us, {kTower});
  examine(detector);
  EXPECT_THAT(names_of(detector), ElementsAre("ball", "box", "tower"));
  EXPECT_LT(largest_change(detector), 0.1F);

  // All is examined again, at first without that light: nobody hears of what is missed then.
  const std::int64_t num_events = detector.num_events();
  detector.examine_all();
  while (detector.num_waiting() > 0) {
    detector.examine_next();
    EXPECT_EQ(names_of(detector).size(), 3U);
  }
  EXPECT_EQ(detector.num_events(), num_events);
  EXPECT_LT(largest_change(detector), 0.1F);
}

/// So many copies of the map beside each other.
ObservedMap copies_of(const ObservedMap& map, std::uint32_t count) {
  ObservedMap all = map;
  all.points_W.clear();
  all.segment_ids.clear();
  for (std::uint32_t copy = 0; copy < count; ++copy) {
    for (std::size_t i = 0; i < map.points_W.size(); ++i) {
      all.points_W.push_back(map.points_W[i]);
      all.points_W.back().x += 3.0F * static_cast<float>(copy);
      all.segment_ids.push_back(map.segment_ids[i] + 10 * copy);
    }
  }
  return all;
}

TEST(Detector, DoesNotKeepWhatWouldStandInAnotherLightThanAllElse) {
  ObservedMap orange = box_on_table();
  make_orange(orange);
  Detector detector(box_ball_and_tower(), 0.01F);
  give(detector, orange, kSecond_us, {kTable, kBox});
  examine(detector);
  ASSERT_THAT(names_of(detector), ElementsAre("box"));
  const std::vector<std::uint32_t> orange_box = {kBox};
  ASSERT_EQ(detection_of(detector, "box").recognition.placement.segment_ids, orange_box);

  const ObservedMap many = copies_of(three_things(), 2);
  give(detector, many, 2 * kSecond_us, {kBall, kTower, 10 + kBox});
  examine(detector);
  EXPECT_THAT(names_of(detector), ElementsAre("ball", "box", "tower"));
  const std::vector<std::uint32_t> other_box = {10 + kBox};
  EXPECT_EQ(detection_of(detector, "box").recognition.placement.segment_ids, other_box);
}

TEST(Detector, LooksForAnObjectOfThisMapInItsLight) {
  constexpr std::int64_t kSession = 7;
  std::vector<ObjectModel> models = box_and_ball();
  for (ObjectModel& model : models) model.map_session = kSession;
  ObservedMap orange = copies_of(box_on_table(), 2);
  make_orange(orange);
  for (const std::int64_t session : {std::int64_t{0}, kSession, kSession + 1}) {
    Detector detector(models, 0.01F, session);
    give(detector, box_on_table(), kSecond_us, {kTable, kBox});
    give(detector, orange, kSecond_us, {10 + kTable, 10 + kBox});
    examine(detector);
    if (session == kSession) {
      EXPECT_THAT(names_of(detector), ElementsAre("box"));
    } else {
      EXPECT_THAT(names_of(detector), ElementsAre("box", "box")) << "another light may be there";
    }
  }
}

// Of the second one less is seen: a union of both is the first one, better than the second one is
// by itself.
TEST(Detector, TellsBothOfTwoThingsAlikeThatTouch) {
  constexpr std::uint32_t kSecond = 5;
  MapOfThings things;
  things.add_box({0.0F, -0.08F, 0.0F}, 0.0F, testing::kBoxSize_m, {"z", "-y", "x"}, kBox);
  things.add_box({0.0F, 0.08F, 0.0F}, 0.0F, testing::kBoxSize_m, {"z", "x"}, kSecond);
  ObservedMap map = things.take();
  constexpr std::size_t kUnseen = 60;  // a tenth of it: else both are told with the same score
  map.points_W.resize(map.points_W.size() - kUnseen);
  map.segment_ids.resize(map.points_W.size());
  Detector detector({box_and_ball()[1]}, 0.01F);
  give(detector, map, kSecond_us, {kBox, kSecond});
  examine(detector);
  EXPECT_THAT(names_of(detector), ElementsAre("box", "box"));
}

TEST(Detector, FindsTheSameOnAllCores) {
  const ObservedMap map = copies_of(box_on_table(), 4);
  const auto points = std::make_shared<const std::vector<CloudPoint>>(map.points_W);
  Detector one(box_and_ball(), 0.01F);
  Detector many(box_and_ball(), 0.01F);
  for (Detector* const detector : {&one, &many}) {
    detector->set_piece(1, points, map.segment_ids, kSecond_us);
    detector->examine_all();
  }
  examine(one);
  while (many.num_waiting() > 0) many.examine_many();
  ASSERT_EQ(one.detections().size(), 8U);
  ASSERT_EQ(many.detections().size(), 8U);
  EXPECT_EQ(one.num_candidates(), many.num_candidates());
  for (std::size_t i = 0; i < one.detections().size(); ++i) {
    const Recognition& a = one.detections()[i].recognition;
    const Recognition& b = many.detections()[i].recognition;
    EXPECT_EQ(a.model, b.model);
    EXPECT_EQ(a.placement.X_WO.matrix(), b.placement.X_WO.matrix());
    EXPECT_EQ(a.placement.score(), b.placement.score());
    EXPECT_EQ(a.placement.segment_ids, b.placement.segment_ids);
  }
}

TEST(Detector, TellsWhatIsNewBeforeAllIsExaminedAgain) {
  const ObservedMap map = copies_of(box_on_table(), 3);
  Detector detector(box_and_ball(), 0.01F);
  give(detector, map, kSecond_us, {kTable, kBox, kBall, 10 + kTable, 10 + kBox, 10 + kBall});
  examine(detector);
  ASSERT_EQ(names_of(detector).size(), 4U);
  give(detector, map, 2 * kSecond_us, {20 + kTable, 20 + kBox, 20 + kBall});
  detector.examine_all();
  std::size_t most_waiting = 0;  // when all is told
  while (detector.num_waiting() > 0) {
    detector.examine_next();
    EXPECT_GE(names_of(detector).size(), 4U);
    if (names_of(detector).size() == 6U) {
      most_waiting = std::max(most_waiting, detector.num_waiting());
    }
  }
  EXPECT_GT(most_waiting, 0U);
  EXPECT_EQ(detector.detections().size(), 6U);
  EXPECT_EQ(names_of(detector).size(), 6U);
}

TEST(Detector, ExaminesAgainLastWhatWasTold) {
  const ObservedMap map = copies_of(box_on_table(), 3);
  for (const auto& [told, added] : {std::pair(kBox, kBall), std::pair(kBall, kBox)}) {
    Detector detector(box_and_ball(), 0.01F);
    give(detector, map, kSecond_us, {kTable, told, 10 + told, 20 + told});
    examine(detector);
    ASSERT_EQ(names_of(detector).size(), 3U);
    give(detector, map, 2 * kSecond_us, {added});
    detector.examine_all();
    while (detector.num_waiting() > 0 && names_of(detector).size() < 4U) detector.examine_next();
    EXPECT_GE(detector.num_waiting(), 3U) << "what was told";
  }
}

TEST(Detector, TellsWhatHasMovedBeforeAllIsExaminedAgain) {
  const ObservedMap map = copies_of(box_on_table(), 4);
  Detector detector(box_and_ball(), 0.01F);
  give(detector, map, kSecond_us, {kTable, kBox, kBall, 10 + kBall, 20 + kBall});
  examine(detector);
  ASSERT_THAT(names_of(detector), ElementsAre("ball", "ball", "ball", "box"));
  const int number = detection_of(detector, "box").number;

  take_away(detector, kBox, 2 * kSecond_us);
  give(detector, map, 2 * kSecond_us, {30 + kBox});
  detector.examine_all();
  const auto has_moved = [&] {
    return detection_of(detector, "box").event == DetectionEvent::kMoved;
  };
  while (detector.num_waiting() > 0 && !has_moved()) detector.examine_next();
  EXPECT_GE(detector.num_waiting(), 2U) << "what was told";
  examine(detector);
  EXPECT_THAT(names_of(detector), ElementsAre("ball", "ball", "ball", "box"));
  EXPECT_EQ(detection_of(detector, "box").number, number);
}

TEST(Detector, TellsNoSecondOneWhileTheFirstMayBeFoundAgain) {
  const ObservedMap map = copies_of(box_on_table(), 4);
  Detector detector(box_and_ball(), 0.01F);
  give(detector, map, kSecond_us, {kTable, kBox, kBall, 10 + kBall, 20 + kBall});  // tell the light
  examine(detector);
  give(detector, map, 2 * kSecond_us, {30 + kBox});
  detector.examine_all();
  while (detector.num_waiting() > 0) {
    detector.examine_next();
    for (const Detection& detection : detector.detections()) {
      EXPECT_NE(detection.event, DetectionEvent::kMoved);
    }
  }
  EXPECT_THAT(names_of(detector), ElementsAre("ball", "ball", "ball", "box", "box"));
}

TEST(Detector, TellsWhatIsInsteadOfSomethingBeforeAllIsExaminedAgain) {
  const ObservedMap map = copies_of(box_on_table(), 4);
  Detector detector(box_and_ball(), 0.01F);
  give(detector, map, kSecond_us, {kTable, kBall, 10 + kBall, 20 + kBall, 30 + kBox});
  examine(detector);
  ASSERT_THAT(names_of(detector), ElementsAre("ball", "ball", "ball", "box"));
  ObservedMap exchanged = map;  // what was the segment of the last ball is that of a box
  for (std::uint32_t& id : exchanged.segment_ids) {
    if (id == 20 + kBox)
      id = 20 + kBall;
    else if (id == 20 + kBall)
      id = kNoSegment;
  }
  give(detector, exchanged, 2 * kSecond_us, {20 + kBall});
  detector.examine_all();
  const auto num_boxes = [&] { return std::ranges::count(names_of(detector), "box"); };
  while (detector.num_waiting() > 0 && num_boxes() < 2) detector.examine_next();
  EXPECT_GE(detector.num_waiting(), 2U) << "what was told";
  EXPECT_EQ(std::ranges::count(names_of(detector), "ball"), 3) << "nothing is gone yet";
  examine(detector);
  EXPECT_THAT(names_of(detector), ElementsAre("ball", "ball", "box", "box"));
}

TEST(Detector, DoesNotLetSegmentsWaitThatAreGone) {
  Detector detector(box_and_ball(), 0.01F);
  give(detector, box_on_table(), kSecond_us);
  examine(detector);
  give(detector, box_on_table({"z", "-y"}), 2 * kSecond_us, {kBox});
  take_away(detector, kTable, 2 * kSecond_us);
  EXPECT_EQ(detector.num_waiting(), 1U);
  take_away(detector, kBox, 3 * kSecond_us);
  EXPECT_EQ(detector.num_waiting(), 1U);  // to tell that what was recognised there is gone
  examine(detector);
  EXPECT_THAT(names_of(detector), ElementsAre("ball"));
}

TEST(Detector, ExaminesFirstWhatIsLikeAnObject) {
  const ObservedMap map = copies_of(box_on_table(), 3);
  Detector detector(box_and_ball(), 0.01F);
  EXPECT_FALSE(detector.examine_next().has_value());
  give(detector, map, kSecond_us, {kTable, 10 + kTable, 20 + kTable});
  give(detector, map, 2 * kSecond_us, {kBox, 10 + kBox});
  EXPECT_EQ(detector.num_waiting(), 5U);
  EXPECT_EQ(detector.examine_next(), 2 * kSecond_us);
  EXPECT_EQ(detector.examine_next(), 2 * kSecond_us);
  EXPECT_THAT(names_of(detector), ElementsAre("box", "box"));
  EXPECT_EQ(detector.examine_next(), kSecond_us);
}

}  // namespace
}  // namespace kintsugi::segmenter
