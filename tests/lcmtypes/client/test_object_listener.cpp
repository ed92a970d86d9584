#include <string>
#include <vector>

#include <gmock/gmock.h>

#include "lcmtypes/channels.hpp"
#include "lcmtypes/client/object_listener.hpp"
#include "lcmtypes/client/object_text.hpp"
#include "tests/support/example_messages.hpp"

namespace kintsugi {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

class ObjectListenerTest : public ::testing::Test {
 protected:
  void hear(const ObjectDetection& detection, double now_s = 0.0) {
    listener_.handle(channels::kObjectDetection, encode(detection), now_s);
  }

  std::vector<std::int64_t> events_;
  std::vector<ChangeKind> changes_;
  ObjectListener listener_{
      "",
      {.on_detection = [this](const ObjectDetection& d) { events_.push_back(d.event_number); },
       .on_change = [this](const ChangeReport& c) { changes_.push_back(c.kind); }}};
};

TEST_F(ObjectListenerTest, TellsEachEventOfTheFirstMapOnce) {
  ObjectDetection detection = testing::example_detection();
  hear(detection, 0.0);
  hear(detection, 1.0);
  detection.map_name = "another";
  detection.event_number = 13;
  hear(detection, 1.1);
  detection.map_name = "office";
  detection.event_number = 14;
  hear(detection, 2.0);
  hear(detection, 3.0);
  EXPECT_THAT(events_, ElementsAre(12, 14));
  EXPECT_EQ(listener_.map_name(), "office");
  EXPECT_EQ(listener_.losses(),
            "1 events of detections were not heard; what is known now is complete without them");
  listener_.handle(channels::kChangeReport, encode(testing::example_change()), 4.0);
  EXPECT_THAT(changes_, ElementsAre(ChangeKind::kMoved));
}

TEST_F(ObjectListenerTest, ANewerDetectorWithoutDetectionsReplacesTheOlder) {
  hear(testing::example_detection());
  DetectorStatus status;
  status.session = 99;
  status.map_session = 42;
  status.map_name = "office";
  listener_.handle(channels::kDetectorStatus, encode(status), 1.0);
  EXPECT_TRUE(listener_.objects().entries().empty());
  ASSERT_TRUE(listener_.detector());
  EXPECT_EQ(listener_.detector()->session, 99);
}

TEST_F(ObjectListenerTest, CountsAndNamesBadMessages) {
  Bytes message = encode(testing::example_detection());
  message.back() ^= 1;
  listener_.handle(channels::kObjectDetection, message, 0.0);
  listener_.handle(channels::kChangeReport, message, 0.0);
  EXPECT_THAT(listener_.dropped(),
              AllOf(HasSubstr("messages of objects dropped: 2"), HasSubstr("change_report_t")));
  EXPECT_TRUE(events_.empty());
}

TEST(ObjectText, HasTheEventThePlaceAndTheSegments) {
  ObjectDetection detection = testing::example_detection();
  EXPECT_EQ(detection_text(detection),
            "object 3 mug-2_blue moved: score 0.75, 812 points at 1.25 -2.50 0.12 m, segments 7 12 "
            "4294967295\n");
  detection.segment_ids = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10};
  EXPECT_THAT(detection_text(detection), HasSubstr("segments 1 2 3 4 5 6 7 8 and 2 more\n"));
  detection.event = DetectionEvent::kGone;
  detection.segment_ids.clear();
  EXPECT_THAT(detection_text(detection), HasSubstr("gone: score 0.75, 812 points at 1.25 -2.50"));
}

TEST(ObjectText, TellsHowFarTheMiddleOfAMovedObjectWent) {
  ChangeReport change = testing::example_change();
  change.motion_W = Pose::Identity();
  change.motion_W.translation().x() = 0.5;
  change.segment_ids = {3};
  EXPECT_EQ(change_text(change),
            "change 2 moved by 0.50 m and 0 degrees: score 0.50, 1234 points in -0.50 -1.50 -2.50 to "
            "0.00 0.25 0.50 m, segment 3, against map 'office yesterday'\n");
  change.kind = ChangeKind::kGone;
  EXPECT_THAT(change_text(change), HasSubstr("change 2 gone: score"));
}

}  // namespace
}  // namespace kintsugi
