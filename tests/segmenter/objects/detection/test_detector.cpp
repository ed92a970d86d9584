#include <algorithm>
#include <cstdint>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>

#include "segmenter/objects/detection/detector.hpp"
#include "segmenter/objects/model/make_model.hpp"
#include "tests/segmenter/objects/box_on_table.hpp"

namespace kintsugi::segmenter {
namespace {

using testing::box_on_table;
using ::testing::ElementsAre;
using testing::kBall;
using testing::kBox;
using testing::kTable;

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
    names.push_back(detector.models()[detection.recognition.model].name);
  }
  std::sort(names.begin(), names.end());
  return names;
}

const Detection& detection_of(const Detector& detector, const std::string& name) {
  const auto at = std::ranges::find_if(detector.detections(), [&](const Detection& detection) {
    return detector.models()[detection.recognition.model].name == name;
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
  const LabelledMap::Change same = labelled.set_piece(1, points, map.segment_ids);
  EXPECT_TRUE(same.segments.empty());
  EXPECT_TRUE(same.blocks.empty());
  std::vector<std::uint32_t> joined = map.segment_ids;
  std::replace(joined.begin(), joined.end(), kBall, kTable);
  const LabelledMap::Change labels = labelled.set_piece(1, points, joined);
  EXPECT_THAT(labels.segments, ElementsAre(kTable, kBall));
  EXPECT_TRUE(labels.blocks.empty());
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

TEST(Detector, ComparesColoursInTheLightThatMostObjectsTell) {
  ObservedMap map = box_on_table();
  for (CloudPoint& p : map.points_W) {
    p.red = static_cast<std::uint8_t>(0.96 * p.red);
    p.green = static_cast<std::uint8_t>(0.92 * p.green);
    p.blue = static_cast<std::uint8_t>(0.88 * p.blue);
  }
  const auto largest_change = [](const Detector& detector) {
    float largest = 0.0F;
    for (const Detection& detection : detector.detections()) {
      largest = std::max(largest, detection.recognition.placement.light.log_gain.norm());
    }
    return largest;
  };
  Detector detector(box_and_ball(), 0.01F);
  give(detector, map, kSecond_us);
  examine(detector);
  EXPECT_EQ(names_of(detector).size(), 2U);
  EXPECT_GT(largest_change(detector), 0.2F);  // two things do not tell the light of a place

  for (CloudPoint& p : map.points_W) p.x += 3.0F;
  constexpr std::uint32_t kOthers = 10;
  for (std::uint32_t& id : map.segment_ids) id += kOthers;
  give(detector, map, 2 * kSecond_us, {kOthers + kTable, kOthers + kBox, kOthers + kBall});
  examine(detector);
  EXPECT_THAT(names_of(detector), ElementsAre("ball", "ball", "box", "box"));
  EXPECT_LT(largest_change(detector), 0.1F);
}

TEST(WaitingSegments, ComeFirstWhenTheyHaveChangedMuch) {
  WaitingSegments waiting;
  EXPECT_FALSE(waiting.since_us().has_value());
  waiting.add(7, 100, 1);
  waiting.add(8, 100, 2);
  waiting.add(7, 110, 3);  // waits already
  EXPECT_EQ(waiting.size(), 2U);
  EXPECT_EQ(waiting.since_us(), 1);
  EXPECT_EQ(waiting.pop(), 7U);
  EXPECT_EQ(waiting.pop(), 8U);

  waiting.add(7, 120, 4);  // a tenth more than when it was examined
  waiting.add(8, 140, 5);
  EXPECT_EQ(waiting.pop(), 8U);
  waiting.add(8, 150, 6);
  waiting.add(8, 70, 7);  // now it has lost half
  EXPECT_EQ(waiting.pop(), 8U);
  EXPECT_EQ(waiting.since_us(), 4);
  waiting.add(8, 71, 8);
  waiting.add(8, 71, 9, true);
  EXPECT_EQ(waiting.pop(), 8U);
  EXPECT_EQ(waiting.pop(), 7U);
  EXPECT_TRUE(waiting.empty());

  waiting.add(7, 0, 10);  // gone
  waiting.add(9, 50, 11);
  EXPECT_EQ(waiting.pop(), 7U);
  waiting.clear();
  EXPECT_FALSE(waiting.contains(9));
  EXPECT_TRUE(waiting.has_changed_much(7, 1));
}

TEST(Detector, WaitsWithTheSegmentThatChangedFirst) {
  Detector detector(box_and_ball(), 0.01F);
  EXPECT_FALSE(detector.waiting_since_us().has_value());
  const ObservedMap map = box_on_table();
  give(detector, map, kSecond_us, {kTable});
  give(detector, map, 2 * kSecond_us, {kBox});
  EXPECT_EQ(detector.num_waiting(), 2U);
  EXPECT_EQ(detector.waiting_since_us(), kSecond_us);
  detector.examine_next();
  EXPECT_EQ(detector.waiting_since_us(), 2 * kSecond_us);
}

}  // namespace
}  // namespace kintsugi::segmenter
