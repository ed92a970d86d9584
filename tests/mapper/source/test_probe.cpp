#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mapper/source/probe.hpp"
#include "mapper/source/recorded_poses.hpp"
#include "tests/mapper/openni2_driver/recording_folder.hpp"

namespace kintsugi::mapper {
namespace {

using test::error_of;
using test::RecordingFolder;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

TEST(Probe, TellsFormatLengthAndCameras) {
  const RecordingFolder folder;
  for (const std::string& device : {folder.path().string(), folder.uri()}) {
    EXPECT_THAT(probe_recording(device),
                AllOf(HasSubstr("TUM RGB-D"), HasSubstr("0.13 s, 5 depth images, 5 colour images"),
                      HasSubstr("64x48 pixels, fx 50 fy 51"), HasSubstr("no distortion"),
                      HasSubstr("the same pixels as depth"), Not(HasSubstr("missing"))));
  }
}

TEST(Probe, TellsWhatIsMissing) {
  const RecordingFolder folder;
  std::filesystem::remove(folder.path() / "depth/1.png");
  std::filesystem::resize_file(folder.path() / "rgb/4.png", 40);
  EXPECT_THAT(probe_recording(folder.path().string()),
              AllOf(HasSubstr("1 of 5 depth images"), HasSubstr("colour: "), HasSubstr("rgb/4.png"),
                    HasSubstr("cut off")));
}

TEST(Probe, OfWhatIsNoRecordingItSaysSo) {
  EXPECT_THAT(error_of<std::invalid_argument>([] { (void)probe_recording("lcm://RGBD_FRAME"); }),
              HasSubstr("'lcm://RGBD_FRAME' is no recording"));
  EXPECT_THAT(error_of<std::runtime_error>([] { (void)probe_recording("/no/such/file"); }),
              HasSubstr("/no/such/file: no such file or folder"));
}

TEST(RecordedPoses, AreThoseOfTheRecordingAtItsDepthImages) {
  const Trajectory poses = recorded_poses("synthetic://office?frames=5");
  ASSERT_EQ(poses.size(), 5U);
  EXPECT_EQ(poses[1].utime - poses[0].utime, 33'333);
  const RecordingFolder without;
  EXPECT_TRUE(recorded_poses(without.path().string()).empty());
}

}  // namespace
}  // namespace kintsugi::mapper
