#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mapper/openni2_driver/formats/calibration.hpp"
#include "tests/mapper/openni2_driver/recording_folder.hpp"

namespace kintsugi::mapper {
namespace {

using test::error_of;
using testing::AllOf;
using testing::HasSubstr;

class CalibrationFile : public testing::Test {
 protected:
  Calibration read(const std::string& text) {
    test::write_text(file_, text);
    return read_calibration(file_);
  }
  std::string error(const std::string& text) {
    return error_of<std::runtime_error>([&] { read(text); });
  }

  test::RecordingFolder folder_;
  std::filesystem::path file_ = folder_.path() / "camera.txt";
};

TEST_F(CalibrationFile, ReadsPinholeWithoutDistortion) {
  const Calibration calibration = read(
      "# fx fy cx cy width height depth_scale\n\n535.4 539.2 320.1 247.6 640 480 5000 # TUM\n");
  const Intrinsics expected{.fx = 535.4,
                            .fy = 539.2,
                            .cx = 320.1,
                            .cy = 247.6,
                            .width = 640,
                            .height = 480,
                            .distortion = {}};
  EXPECT_EQ(calibration.intrinsics, expected);
  EXPECT_EQ(calibration.depth_units_per_m, 5000.0);
}

TEST_F(CalibrationFile, ReadsDistortionInTheOrderOfOpenCv) {
  const Calibration calibration =
      read("517 516 318 255 640 480 5000 0.2624 -0.9531 -0.0054 0.0026 1.1633\n");
  const std::array<double, 5> expected = {0.2624, -0.9531, -0.0054, 0.0026, 1.1633};
  EXPECT_EQ(calibration.intrinsics.distortion, expected);
}

TEST_F(CalibrationFile, KeepsANegativeFy) {
  const Calibration calibration = read("481.2 -480 319.5 239.5 640 480 5000\n");
  EXPECT_EQ(calibration.intrinsics.fy, -480.0);
  EXPECT_EQ(calibration.intrinsics.cy, 239.5);
}

TEST_F(CalibrationFile, MissingFieldIsNamed) {
  EXPECT_THAT(error("535 539 320 247 640 480\n"),
              AllOf(HasSubstr("camera.txt:1"), HasSubstr("6 fields"), HasSubstr("depth_scale")));
  EXPECT_THAT(error("# c\n535 539 320 247 640 480 1000 0.1 0.2\n"),
              AllOf(HasSubstr("camera.txt:2"), HasSubstr("p1")));
}

TEST_F(CalibrationFile, BadValueIsNamedWithItsBound) {
  EXPECT_THAT(error("0 539 320 247 640 480 1000"),
              AllOf(HasSubstr("fx is '0'"), HasSubstr("greater than 0")));
  EXPECT_THAT(error("-535 539 320 247 640 480 1000"), HasSubstr("fx is '-535'"));
  EXPECT_THAT(error("535 0 320 247 640 480 1000"),
              AllOf(HasSubstr("fy is '0'"), HasSubstr("other than 0")));
  EXPECT_THAT(error("535 539 abc 247 640 480 1000"), HasSubstr("cx is 'abc'"));
  EXPECT_THAT(error("535 539 320 2,5 640 480 1000"), HasSubstr("cy is '2,5'"));
  EXPECT_THAT(error("535 539 320 247 640.5 480 1000"), HasSubstr("width is '640.5'"));
  EXPECT_THAT(error("535 539 320 247 640 99999 1000"), HasSubstr("height is '99999'"));
  EXPECT_THAT(error("535 539 320 247 640 480 0"), HasSubstr("depth_scale is '0'"));
  EXPECT_THAT(error("535 539 320 247 640 480 inf"), HasSubstr("depth_scale is 'inf'"));
  EXPECT_THAT(error("535 539 320 247 640 480 1000 nan 0 0 0 0"), HasSubstr("k1 is 'nan'"));
}

TEST_F(CalibrationFile, NothingOrTooMuchIsRefused) {
  EXPECT_THAT(error("# only a comment\n"), HasSubstr("no calibration"));
  EXPECT_THAT(error("1 1 1 1 1 1 1\n2 2 2 2 2 2 2\n"), HasSubstr("camera.txt:2"));
  std::filesystem::remove(file_);
  EXPECT_THAT(error_of<std::runtime_error>([&] { read_calibration(file_); }),
              HasSubstr("camera.txt: cannot be read"));
}

}  // namespace
}  // namespace kintsugi::mapper
