#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mapper/openni2_driver/formats/frame_stamps.hpp"
#include "mapper/openni2_driver/recording/recording_uri.hpp"
#include "tests/mapper/openni2_driver/formats/written_recordings.hpp"

namespace kintsugi::mapper {
namespace {

namespace fs = std::filesystem;
using test::error_of;
using test::open_recording_at;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Optional;

TEST(ReadRecording, AFolderAboveRecordingsNamesThem) {
  const kintsugi::testing::TemporaryFolder folder;
  for (const char* name : {"seq-02", "seq-01"}) {
    fs::create_directories(folder / name);
    cv::imwrite((folder / name / "frame-000000.depth.png").string(), test::raw_depth_image(0));
  }
  fs::create_directories(folder / "other");
  EXPECT_THAT(error_of<std::runtime_error>([&] { (void)open_recording_at(folder.path()); }),
              AllOf(HasSubstr(folder.path().string()), HasSubstr(": seq-01 seq-02")));
}

TEST(ReadRecording, AFileOfAnotherKindIsRefusedWithTheKindsThatThereAre) {
  const kintsugi::testing::TemporaryFolder folder;
  for (const std::string& bytes : {std::string("ply\nformat ascii 1.0\n"), std::string(),
                                   std::string(2000, '\0'), std::string(2000, '\xff')}) {
    test::write_text(folder / "file", bytes);
    EXPECT_THAT(error_of<std::runtime_error>([&] { (void)open_recording_at(folder / "file"); }),
                AllOf(HasSubstr("/file: "), HasSubstr(".klg"), HasSubstr(".sens")));
  }
}

TEST(ReadRecording, TheNameOfAFileDoesNotMatter) {
  const kintsugi::testing::TemporaryFolder folder;
  const test::KlgImages images = {test::raw_bytes(test::raw_depth_image(0)),
                                  test::raw_bytes(test::color_image(0))};
  test::write_text(folder / "renamed.dat", test::klg_bytes({images}, 1));
  EXPECT_THAT(open_recording_at(folder / "renamed.dat").contents().format, HasSubstr(".klg"));
}

TEST(ReadRecording, TheAddressCarriesTheOptions) {
  const auto uri = parse_recording_uri(
      "recording:///data/a.bag?depth_topic=/cam/depth&color_topic=/cam/"
      "rgb&swap_colors=on&camera=on");
  ASSERT_TRUE(uri);
  EXPECT_EQ(uri->scheme, RecordingUri::Scheme::kRecording);
  EXPECT_EQ(uri->path, "/data/a.bag");
  EXPECT_EQ(uri->reading.depth_topic, "/cam/depth");
  EXPECT_EQ(uri->reading.color_topic, "/cam/rgb");
  EXPECT_TRUE(uri->reading.swap_colors);
  EXPECT_TRUE(uri->imitation.camera);
  EXPECT_THAT(error_of<std::invalid_argument>(
                  [] { parse_recording_uri("recording:///data/a.klg?swap_colors=maybe"); }),
              AllOf(HasSubstr("maybe"), HasSubstr("on or off")));
  EXPECT_THAT(error_of<std::invalid_argument>(
                  [] { parse_recording_uri("recording:///data/a.klg?topic=x"); }),
              AllOf(HasSubstr("'topic'"), HasSubstr("depth_topic=")));
}

TEST(ReadRecording, TumsFoldersAreKnownByTheirNames) {
  const kintsugi::testing::TemporaryFolder folder;
  const auto as = [&](const char* name) {
    const fs::path path = folder / name;
    fs::create_directories(path);
    test::write_text(path / "depth.txt", "1.5 depth/1.png\n");
    return open_recording_at(path);
  };
  EXPECT_NEAR(as("rgbd_dataset_freiburg1_desk").intrinsics().fx, 517.3, 0.1);
  EXPECT_NEAR(as("rgbd_dataset_freiburg1_desk").intrinsics().distortion[0], 0.2624, 1e-4);
  EXPECT_NEAR(as("fr2_xyz").intrinsics().fx, 520.9, 0.1);
  const FileRecording third = as("rgbd_dataset_freiburg3_structure_notexture_far");
  EXPECT_EQ(third.intrinsics().fx, 535.4);
  EXPECT_EQ(third.contents().calibration.depth_units_per_m, 5000.0);
  EXPECT_THAT(third.remark(), HasSubstr("freiburg3"));
  EXPECT_THAT(error_of<std::runtime_error>([&] { (void)as("my_desk"); }),
              AllOf(HasSubstr("camera.txt"), HasSubstr("freiburg1")));
}

TEST(ReadRecording, FrameNumbersMeanTheCameraOfIclNuim) {
  const kintsugi::testing::TemporaryFolder folder;
  test::write_text(folder / "associations.txt",
                   "1 depth/1.png 1 rgb/1.png\n2 depth/2.png 2 rgb/2.png\n");
  const FileRecording recording = open_recording_at(folder.path());
  EXPECT_EQ(recording.intrinsics().fy, -480.0) << "y points up in its images";
  EXPECT_THAT(recording.remark(), HasSubstr("ICL-NUIM"));
}

TEST(FrameStamps, TheUnitIsTheOneInWhichTheStepsAreACameras) {
  EXPECT_THAT(times_of_stamps({100, 133, 167}), Optional(ElementsAre(0, 33'000, 67'000)));
  EXPECT_THAT(times_of_stamps({5'000'000, 5'033'333}), Optional(ElementsAre(0, 33'333)));
  EXPECT_THAT(times_of_stamps({1'700'000'000'000'000'000, 1'700'000'000'033'333'000}),
              Optional(ElementsAre(0, 33'333)));
  EXPECT_THAT(times_of_stamps({7, 8, 9}), Optional(ElementsAre(0, 1'000'000, 2'000'000)));
  EXPECT_EQ(times_of_stamps({1, 1}), std::nullopt);
  EXPECT_EQ(times_of_stamps({1}), std::nullopt);
  EXPECT_EQ(times_of_stamps({0, 1'000'000'000'000'000'000}), std::nullopt);
}

}  // namespace
}  // namespace kintsugi::mapper
