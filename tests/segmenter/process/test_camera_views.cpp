// Which view of a camera counts.

#include <gtest/gtest.h>

#include "segmenter/process/camera_views.hpp"
#include "tests/segmenter/query/camera_view.hpp"

namespace kintsugi::segmenter {
namespace {

using Clock = CameraViews::Clock;

CameraView view_at(std::int64_t utime, std::int64_t session = 5) {
  CameraView view = testing::blind_view(session, Pose::Identity());
  view.utime = utime;
  view.color_jpeg = {1, 2, 3};
  return view;
}

TEST(CameraViews, TheNewestOfEachSessionIsKeptWithoutColour) {
  CameraViews views;
  views.add(view_at(200), Clock::now());
  views.add(view_at(100), Clock::now());  // overtaken by the other
  views.add(view_at(300, 6), Clock::now());
  ASSERT_TRUE(views.newest(5));
  EXPECT_EQ(views.newest(5)->utime, 200);
  EXPECT_TRUE(views.newest(5)->color_jpeg.empty());
  EXPECT_EQ(views.newest(6)->utime, 300);
  EXPECT_FALSE(views.newest(7));
}

TEST(CameraViews, AViewThatIsOldDoesNotShowWhatIsThereNow) {
  CameraViews views;
  views.add(view_at(200), Clock::now() - 2 * CameraViews::kMaxAge);
  EXPECT_FALSE(views.newest(5));
}

TEST(CameraViews, ALostCameraHasNoViewUntilItIsFoundAgain) {
  CameraViews views;
  views.add(view_at(100), Clock::now());
  CameraView lost = view_at(200);
  lost.state = TrackingState::kLost;
  views.add(lost, Clock::now());
  EXPECT_FALSE(views.newest(5));
  views.add(view_at(300), Clock::now());
  EXPECT_TRUE(views.newest(5));
}

TEST(CameraViews, SessionsBeyondTheLimitReplaceTheOldest) {
  CameraViews views;
  for (std::int64_t session = 1; session <= 65; ++session) {
    views.add(view_at(100, session), Clock::now());
  }
  EXPECT_FALSE(views.newest(1));
  EXPECT_TRUE(views.newest(2));
  EXPECT_TRUE(views.newest(65));
}

}  // namespace
}  // namespace kintsugi::segmenter
