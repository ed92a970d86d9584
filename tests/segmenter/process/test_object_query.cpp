// kintsugi-query --object: what a detector on the bus repeats.

#include <atomic>
#include <chrono>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "lcmtypes/bus/bus.hpp"
#include "lcmtypes/channels.hpp"
#include "segmenter/tools/query/object_query.hpp"
#include "segmenter/tools/query/object_report.hpp"
#include "tests/support/example_messages.hpp"
#include "tests/support/private_bus.hpp"

namespace kintsugi::segmenter {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

ObjectDetection detected(std::int32_t number, const std::string& name, DetectionEvent event) {
  ObjectDetection detection = kintsugi::testing::example_detection();
  detection.detection = number;
  detection.num_detections = 3;
  detection.event_number = 10 + number;
  detection.name = name;
  detection.event = event;
  return detection;
}

/// Publishes again and again until the end of its life.
class Repeater {
 public:
  Repeater(const std::string& url, const std::vector<ObjectDetection>& detections,
           const DetectorStatus& status)
      : thread_([this, url, detections, status] {
          Bus bus(url);
          while (!ends_) {
            for (const auto& d : detections) bus.publish(channels::kObjectDetection, d);
            if (status.session != 0) bus.publish(channels::kDetectorStatus, status);
            std::this_thread::sleep_for(std::chrono::milliseconds(50));
          }
        }) {}
  ~Repeater() {
    ends_ = true;
    thread_.join();
  }
  Repeater(const Repeater&) = delete;
  Repeater& operator=(const Repeater&) = delete;

 private:
  std::atomic<bool> ends_{false};
  std::thread thread_;
};

constexpr std::chrono::seconds kTimeout(30);

class ObjectQuery : public ::testing::Test {
 protected:
  void SetUp() override {
    static const std::optional<std::string> why_not = kintsugi::testing::enter_private_bus();
    if (why_not) GTEST_SKIP() << *why_not;
  }
};

TEST_F(ObjectQuery, HasAllDetectionsOfTheName) {
  const std::string url = kintsugi::testing::kPrivateBusUrl;
  const Repeater repeater(
      url,
      {detected(1, "mug", DetectionEvent::kConfirmed), detected(2, "chair", DetectionEvent::kFound),
       detected(3, "mug", DetectionEvent::kGone)},
      {});
  FoundObjects found = ask_detector(url, "", kTimeout);
  EXPECT_EQ(found.detections.size(), 3U);
  EXPECT_EQ(found.dropped, "");
  keep_named("mug", found);
  ASSERT_EQ(found.detections.size(), 2U);
  EXPECT_TRUE(any_present(found));
  EXPECT_THAT(objects_table(found),
              AllOf(HasSubstr("map 'office' of session 42: 2 detections"), HasSubstr("confirmed"),
                    HasSubstr("gone"), HasSubstr("1.250 -2.500 0.125")));
  keep_named("spoon", found);
  EXPECT_FALSE(any_present(found));
  EXPECT_THAT(objects_table(found), HasSubstr("no such object found"));
}

TEST_F(ObjectQuery, TellsOfInvalidMessages) {
  const std::string url = kintsugi::testing::kPrivateBusUrl;
  const Repeater repeater(url, {detected(1, "mug", DetectionEvent::kConfirmed)}, {});
  std::atomic<bool> is_done = false;
  std::thread hostile([&] {
    Bus bus(url);
    while (!is_done) {
      bus.publish(channels::kObjectDetection, Bytes(40, 0xFF));
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  });
  // It listens for some time, because the detection says that there are three.
  const FoundObjects found = ask_detector(url, "", kTimeout);
  is_done = true;
  hostile.join();
  EXPECT_EQ(found.detections.size(), 1U);
  EXPECT_THAT(found.dropped, HasSubstr("messages of objects dropped: "));
}

TEST_F(ObjectQuery, ADetectorThatHasFoundNothingAnswers) {
  const std::string url = kintsugi::testing::kPrivateBusUrl;
  DetectorStatus status;
  status.session = 47;
  status.map_session = 42;
  status.map_name = "office";
  const Repeater repeater(url, {}, status);
  const FoundObjects found = ask_detector(url, "office", kTimeout);
  EXPECT_EQ(found.map_session, 42);
  EXPECT_TRUE(found.detections.empty());
}

TEST_F(ObjectQuery, NobodyIsHeard) {
  try {
    ask_detector(kintsugi::testing::kPrivateBusUrl, "cellar", std::chrono::milliseconds(60));
    FAIL() << "answered";
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("no detector of objects was heard within 0.06 s"),
                                    HasSubstr("for map 'cellar'")));
  }
}

TEST(ObjectReport, JsonHasThePoseAsTranslationAndQuaternion) {
  ObjectDetection detection = detected(1, "mug", DetectionEvent::kMoved);
  detection.X_WO = Pose::Identity();
  detection.X_WO.linear() = Eigen::AngleAxisd(EIGEN_PI, Eigen::Vector3d::UnitZ()).matrix();
  detection.X_WO.translation() << 1, 2, 3;
  const FoundObjects found{.map_name = "office",
                           .map_session = 42,
                           .session = 47,
                           .newest_utime = detection.utime + 1'500'000,
                           .detections = {detection},
                           .dropped = ""};
  const auto json = nlohmann::json::parse(objects_json(found));
  EXPECT_EQ(json["map"]["name"], "office");
  const auto& object = json["objects"][0];
  EXPECT_EQ(object["name"], "mug");
  EXPECT_EQ(object["state"], "moved");
  EXPECT_EQ(object["pose"]["translation"], (std::vector<double>{1, 2, 3}));
  EXPECT_NEAR(object["pose"]["quaternion"][2], 1.0, 1e-12);
  EXPECT_NEAR(object["pose"]["quaternion"][3], 0.0, 1e-12);
  EXPECT_EQ(object["segments"], (std::vector<std::uint32_t>{7, 12, 0xFFFFFFFFU}));
  EXPECT_DOUBLE_EQ(object["age_s"], 1.5);
  EXPECT_EQ(object["box"]["max"].size(), 3U);
}

}  // namespace
}  // namespace kintsugi::segmenter
