#include <algorithm>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "lcmtypes/client/event_table.hpp"

namespace kintsugi {
namespace {

ObjectDetection detected(std::int32_t detection, std::int64_t event_number, DetectionEvent event) {
  ObjectDetection message;
  message.session = 50;
  message.map_session = 7;
  message.map_name = "map";
  message.detection = detection;
  message.num_detections = 9;
  message.event_number = event_number;
  message.event = event;
  message.name = "mug";
  return message;
}

std::vector<std::int32_t> numbers_of(const std::vector<ObjectDetection>& detections) {
  std::vector<std::int32_t> numbers;
  numbers.reserve(detections.size());
  for (const ObjectDetection& detection : detections) numbers.push_back(detection.detection);
  return numbers;
}

using Numbers = std::vector<std::int32_t>;

TEST(EventTable, OfADetectionTheNewestEventCounts) {
  ObjectTable table;
  EXPECT_TRUE(table.apply(detected(1, 1, DetectionEvent::kFound), 0.0));
  EXPECT_TRUE(table.apply(detected(1, 4, DetectionEvent::kGone), 0.1));
  EXPECT_TRUE(table.apply(detected(1, 2, DetectionEvent::kConfirmed), 0.2));  // it came late
  EXPECT_EQ(table.entries().at(1).message.event, DetectionEvent::kGone);
  EXPECT_TRUE(table.apply(detected(2, 3, DetectionEvent::kConfirmed), 0.3));
  EXPECT_EQ(numbers_of(table.present()), Numbers{2});
  EXPECT_EQ(table.num_numbered(), 9);
}

TEST(EventTable, ARepeatedMessageIsNoEventButMayHaveNewerNumbers) {
  ObjectTable table;
  ObjectDetection message = detected(1, 1, DetectionEvent::kFound);
  message.utime = 100;
  EXPECT_TRUE(table.apply(message, 0.0));
  EXPECT_FALSE(table.apply(message, 1.0));
  message.utime = 200;
  message.score = 0.5F;
  EXPECT_FALSE(table.apply(message, 2.0));
  EXPECT_EQ(table.entries().at(1).message.score, 0.5F);
  message.utime = 150;
  message.score = 0.25F;
  EXPECT_FALSE(table.apply(message, 3.0));
  EXPECT_EQ(table.entries().at(1).message.score, 0.5F);
}

TEST(EventTable, TheOrderOfMessagesDoesNotMatter) {
  std::vector<ObjectDetection> messages;
  for (std::int32_t i = 1; i <= 40; ++i) {
    messages.push_back(detected(1 + i % 7, i, DetectionEvent{static_cast<std::int8_t>(i % 4)}));
    messages.push_back(messages.back());
  }
  std::mt19937 random(3);
  Numbers expected;
  for (int trial = 0; trial < 20; ++trial) {
    ObjectTable table;
    int num_events = 0;
    for (const ObjectDetection& message : messages) {
      num_events += table.apply(message, 0.0) ? 1 : 0;
    }
    EXPECT_EQ(num_events, 40);
    if (trial == 0) expected = numbers_of(table.present());
    EXPECT_EQ(numbers_of(table.present()), expected);
    std::ranges::shuffle(messages, random);
  }
  EXPECT_FALSE(expected.empty());
  EXPECT_LT(expected.size(), 7U);
}

TEST(EventTable, ANewerSessionReplacesAnOlderOne) {
  ObjectTable table;
  table.apply(detected(1, 5, DetectionEvent::kFound), 0.0);
  ObjectDetection restarted = detected(2, 1, DetectionEvent::kFound);
  restarted.session = 60;
  EXPECT_TRUE(table.apply(restarted, 1.0));
  EXPECT_EQ(numbers_of(table.present()), Numbers{2});
  EXPECT_FALSE(table.apply(detected(1, 6, DetectionEvent::kFound), 2.0));
  EXPECT_EQ(numbers_of(table.present()), Numbers{2});
  ObjectDetection other_map = detected(3, 1, DetectionEvent::kFound);
  other_map.map_session = 8;
  EXPECT_TRUE(table.apply(other_map, 3.0));
  EXPECT_EQ(numbers_of(table.present()), Numbers{3});
  EXPECT_EQ(table.session(), 50);
  table.hear_sender(8, 70, 4.0);  // that has found nothing yet
  EXPECT_TRUE(table.entries().empty());
}

TEST(EventTable, WhatAHeardSenderDoesNotRepeatIsDropped) {
  ObjectTable table;
  table.apply(detected(1, 1, DetectionEvent::kFound), 0.0);
  table.apply(detected(2, 2, DetectionEvent::kFound), 0.0);
  EXPECT_EQ(numbers_of(table.present()), (Numbers{1, 2})) << "a silent sender drops nothing";
  table.apply(detected(2, 2, DetectionEvent::kFound), 9.0);
  EXPECT_EQ(numbers_of(table.present()), (Numbers{1, 2}));
  table.hear_sender(7, 40, 15.0);  // an older one
  EXPECT_EQ(numbers_of(table.present()), (Numbers{1, 2}));
  table.hear_sender(7, 50, 15.0);
  EXPECT_EQ(numbers_of(table.present()), Numbers{2});
  EXPECT_FALSE(table.apply(detected(1, 1, DetectionEvent::kFound), 16.0)) << "no event twice";
  EXPECT_EQ(numbers_of(table.present()), (Numbers{1, 2}));
}

TEST(EventTable, EventsAreLostOnlyAfterTheCallerJoined) {
  ObjectTable table;
  table.apply(detected(2, 30, DetectionEvent::kConfirmed), 100.0);
  table.apply(detected(1, 20, DetectionEvent::kConfirmed), 101.0);
  EXPECT_EQ(table.num_lost(), 0);
  table.apply(detected(1, 31, DetectionEvent::kMoved), 102.0);
  EXPECT_EQ(table.num_lost(), 0);
  table.apply(detected(1, 34, DetectionEvent::kMoved), 103.0);
  EXPECT_EQ(table.num_lost(), 2);
  table.apply(detected(2, 32, DetectionEvent::kGone), 104.0);  // repeated
  EXPECT_EQ(table.num_lost(), 1);
}

TEST(EventTable, AHostileSenderCannotFillTheMemory) {
  ObjectTable table;
  for (std::int32_t i = 1; i <= 70'000; ++i) {
    table.apply(detected(i, 3LL * i, DetectionEvent::kFound), 0.0);
  }
  EXPECT_EQ(table.entries().size(), ObjectTable::kMaxEntries);
}

TEST(EventTable, AWithdrawnChangeIsNotPresent) {
  ChangeReport change;
  change.session = 50;
  change.map_session = 7;
  change.change = 1;
  change.event_number = 1;
  change.kind = ChangeKind::kGone;
  ChangeTable table;
  EXPECT_TRUE(table.apply(change, 0.0));
  EXPECT_EQ(table.present().size(), 1U) << "that the object is gone is so";
  change.event_number = 2;
  change.kind = ChangeKind::kWithdrawn;
  EXPECT_TRUE(table.apply(change, 1.0));
  EXPECT_TRUE(table.present().empty());
}

}  // namespace
}  // namespace kintsugi
