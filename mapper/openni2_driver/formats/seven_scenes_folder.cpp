#include <utility>

#include "mapper/openni2_driver/formats/camera_file.hpp"
#include "mapper/openni2_driver/formats/folder_formats.hpp"
#include "mapper/openni2_driver/formats/folder_name.hpp"
#include "mapper/openni2_driver/formats/image_files.hpp"
#include "mapper/openni2_driver/formats/numbered_images.hpp"

namespace kintsugi::mapper {
namespace {

namespace fs = std::filesystem;

/// What the dataset's authors say of its Kinect; depth in millimetres.
constexpr Calibration kKinect = {.intrinsics = {.fx = 585.0,
                                                .fy = 585.0,
                                                .cx = 320.0,
                                                .cy = 240.0,
                                                .width = 640,
                                                .height = 480,
                                                .distortion = {}},
                                 .depth_units_per_m = 1000.0};

std::vector<NumberedImage> frames(const fs::path& folder, std::string_view suffix) {
  return numbered_images(folder, "frame-", suffix);
}

}  // namespace

bool is_seven_scenes_folder(const fs::path& folder) {
  return !frames(folder, ".depth.png").empty();
}

RecordingContents read_seven_scenes_folder(const fs::path& folder) {
  RecordingContents contents;
  contents.format = "sequence of 7-Scenes";
  contents.name = name_of(folder);
  const auto own = own_calibration(folder);
  contents.calibration = own.value_or(kKinect);
  if (!own) {
    contents.remarks.emplace_back(
        "the camera is the Kinect of 7-Scenes, as its authors publish it");
  }
  const auto depth = frames(folder, ".depth.png");
  const auto color = frames(folder, ".color.png");
  contents.depth_utimes = times_of(depth);
  contents.color_utimes = times_of(color);
  for (const NumberedImage& image : depth) {
    const std::string name = image.file.filename().string();
    contents.depth_X_WC.push_back(
        read_pose(folder / (name.substr(0, name.find('.')) + ".pose.txt")));
  }
  const Intrinsics& camera = contents.calibration.intrinsics;
  const cv::Size size(camera.width, camera.height);
  contents.images = std::make_unique<ImageFiles>(
      ImageFiles::Files{.depth = files_of(depth), .color = files_of(color), .confidence = {}}, size,
      size);
  return contents;
}

}  // namespace kintsugi::mapper
