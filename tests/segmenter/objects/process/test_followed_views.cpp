// What a detector is told of the views of a map on the bus.

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <gmock/gmock.h>

#include "lcmtypes/patch_motions.hpp"
#include "segmenter/objects/process/followed_views.hpp"
#include "segmenter/views/view_record.hpp"

namespace kintsugi::segmenter {
namespace {

using std::chrono::seconds;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr std::int64_t kSession = 5;

/// Imitates a segmenter that has recorded a view for each of some times.
class FollowedViewsTest : public ::testing::Test {
 protected:
  /// Until nothing is on its way. The clock stands still.
  /// @return whether something was news
  bool settle(bool map_has_ended = false) {
    bool is_news = false;
    do {
      is_news |= views_.update(map_has_ended, detector_, now_);
      std::this_thread::yield();
    } while (views_.is_asking());
    return is_news;
  }

  [[nodiscard]] MapView view_at(std::int64_t utime) const {
    MapView view;
    view.utime = utime;
    view.intrinsics.fx = view.intrinsics.fy = 1.0;
    view.intrinsics.width = view.intrinsics.height = 1;
    view.depth_mm = {depth_mm_};
    return view;
  }

  FollowedViews::Answer answer(const FollowedViews::Request& request) {
    asked_.push_back(request.since_us);
    FollowedViews::Answer answer{.request = request};
    for (const std::int64_t utime : recorded_) {
      if (utime < request.since_us) continue;
      if (answer.views.size() == most_) {
        answer.problem = "silence";
        break;
      }
      answer.views.push_back(view_at(utime));
    }
    return answer;
  }

  // Nobody asks while the test changes these.
  std::vector<std::int64_t> recorded_;  // by time
  std::size_t most_ = 10'000;           // it does not tell more views at once
  std::uint16_t depth_mm_ = 1000;       // in each view
  std::vector<std::int64_t> asked_;     // since when
  FollowedViews::Clock::time_point now_{seconds(1000)};
  Detector detector_{{}, 0.01F};
  FollowedViews views_{[this](const FollowedViews::Request& request) { return answer(request); }};
};

TEST_F(FollowedViewsTest, AreAskedForSinceTheLastAnswer) {
  views_.begin(kSession);
  recorded_ = {10, 20};
  settle();
  EXPECT_EQ(detector_.num_views(), 2U);
  settle();  // not yet again
  recorded_ = {10, 20, 30};
  now_ += seconds(1);
  settle();
  EXPECT_THAT(asked_, ElementsAre(0, 21));
  EXPECT_EQ(detector_.num_views(), 3U);
}

TEST_F(FollowedViewsTest, OfANewDetectorAreNotWhatTheOldOneAwaited) {
  views_.begin(kSession);
  recorded_ = {10, 20};
  settle();
  now_ += seconds(1);
  recorded_ = {10, 20, 30};
  views_.update(false, detector_, now_);  // asks since 21
  ASSERT_TRUE(views_.is_asking());
  detector_.set_views({});
  views_.begin(kSession);
  settle();
  EXPECT_THAT(asked_, ElementsAre(0, 21, 0));
  EXPECT_EQ(detector_.num_views(), 3U);
}

TEST_F(FollowedViewsTest, OfAnAnswerThatBreaksOffAreKept) {
  views_.begin(kSession);
  recorded_ = {10, 20, 30};
  most_ = 2;
  settle();
  EXPECT_EQ(detector_.num_views(), 2U);
  now_ += seconds(60);
  settle();
  EXPECT_THAT(asked_, ElementsAre(0, 21));
  EXPECT_EQ(detector_.num_views(), 3U);
}

TEST_F(FollowedViewsTest, OfAMapThatHasEndedAreAskedForUntilAllHaveCome) {
  views_.begin(kSession);
  recorded_ = {10, 20, 30};
  settle();
  most_ = 1;
  settle(true);
  EXPECT_FALSE(views_.are_complete());
  EXPECT_EQ(detector_.num_views(), 1U);
  most_ = 2;
  now_ += seconds(1);
  settle(true);
  EXPECT_TRUE(views_.are_complete());
  EXPECT_EQ(views_.problem(), "");
  EXPECT_THAT(asked_, ElementsAre(0, 0, 11));
  EXPECT_EQ(detector_.num_views(), 3U);
  now_ += seconds(60);
  settle(true);
  EXPECT_EQ(asked_.size(), 3U);
}

TEST_F(FollowedViewsTest, OfAMapThatHasEndedAreNewsIfTheyAreOthersThanBefore) {
  views_.begin(kSession);
  recorded_ = {10, 20};
  EXPECT_TRUE(settle());
  EXPECT_FALSE(settle(true));
  EXPECT_TRUE(views_.are_complete());
  views_.go_on();
  recorded_ = {10, 20, 30};
  EXPECT_TRUE(settle(true));
  EXPECT_TRUE(views_.are_complete());
  views_.go_on();
  recorded_ = {10, 30};  // as many views that are others
  EXPECT_TRUE(settle(true));
  views_.go_on();
  depth_mm_ = 2000;
  EXPECT_TRUE(settle(true));
  EXPECT_FALSE(settle(true));
}

TEST_F(FollowedViewsTest, OfAMapThatHasEndedAreGivenUpAfterSomeTries) {
  views_.begin(kSession);
  recorded_ = {10, 20};
  settle();
  most_ = 0;
  for (int i = 0; i < 20; ++i) {
    settle(true);
    EXPECT_EQ(views_.are_complete(), !views_.problem().empty());
    now_ += seconds(1);
  }
  EXPECT_TRUE(views_.are_complete());
  EXPECT_THAT(views_.problem(), HasSubstr("silence"));
  EXPECT_THAT(asked_, ElementsAre(0, 0, 0, 0));
  EXPECT_EQ(detector_.num_views(), 2U);  // better than none

  views_.go_on();
  most_ = 10'000;
  settle();
  EXPECT_EQ(views_.problem(), "");
  settle(true);
  EXPECT_TRUE(views_.are_complete());
}

TEST_F(FollowedViewsTest, OfACorrectedMapAreAllAskedForAgainAtMostOnceAMinute) {
  views_.begin(kSession);
  recorded_ = {10, 20};
  settle();
  now_ += seconds(60);
  views_.note_correction(now_);
  settle();
  EXPECT_THAT(asked_, ElementsAre(0));  // the segmenter may not know of the correction yet
  recorded_ = {20};                     // meanwhile it has thinned them out
  now_ += seconds(1);
  settle();
  EXPECT_THAT(asked_, ElementsAre(0, 0));
  EXPECT_EQ(detector_.num_views(), 1U);
  asked_.clear();
  for (int i = 0; i < 60; ++i) {
    views_.note_correction(now_);
    now_ += seconds(1);
    settle();
  }
  EXPECT_EQ(std::ranges::count(asked_, 0), 1);
  EXPECT_EQ(std::ranges::count(asked_, 21), 59);
}

TEST_F(FollowedViewsTest, AreBounded) {
  views_.begin(kSession);
  std::size_t most = 0;
  for (std::int64_t utime = 1; utime <= 10'000; ++utime) {
    recorded_.push_back(utime);
    if (recorded_.size() > ViewRecord::kMaxViews) recorded_.erase(recorded_.begin());
    if (utime % 100 != 0) continue;
    now_ += seconds(10);
    settle();
    most = std::max(most, detector_.num_views());
  }
  EXPECT_GT(most, ViewRecord::kMaxViews);
  EXPECT_LE(most, 2 * ViewRecord::kMaxViews + 700);  // what came in a minute
}

TEST(MovedPiece, HasTheSamePointsElsewhere) {
  std::vector<CloudPoint> before_W(2);
  before_W[0].red = 7;
  before_W[1].weight = 3.0F;
  before_W[1].y = 1.0F;
  Pose X_WP = Pose::Identity();
  X_WP.translation().x() = 0.5;
  const std::vector<CloudPoint> now_W = moved(before_W, X_WP);
  EXPECT_TRUE(is_moved(before_W, now_W));
  EXPECT_FALSE(is_moved(before_W, before_W));
  std::vector<CloudPoint> fused_W = now_W;
  fused_W[0].weight = 1.0F;
  EXPECT_FALSE(is_moved(before_W, fused_W));
  EXPECT_FALSE(is_moved(before_W, std::span(now_W).first(1)));
}

}  // namespace
}  // namespace kintsugi::segmenter
