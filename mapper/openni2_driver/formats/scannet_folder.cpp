#include <utility>

#include "mapper/openni2_driver/formats/camera_file.hpp"
#include "mapper/openni2_driver/formats/folder_formats.hpp"
#include "mapper/openni2_driver/formats/folder_name.hpp"
#include "mapper/openni2_driver/formats/frame_numbers.hpp"
#include "mapper/openni2_driver/formats/image_files.hpp"
#include "mapper/openni2_driver/formats/numbered_images.hpp"

namespace kintsugi::mapper {
namespace {

namespace fs = std::filesystem;

constexpr double kUnits_per_m = 1000.0;

/// Pose of the depth camera in the colour camera: both files have the pose of a camera in the
/// device, and are the identity in ScanNet.
Pose color_X_RC(const fs::path& intrinsic) {
  const auto X_DC = read_pose(intrinsic / "extrinsic_depth.txt");
  const auto X_DR = read_pose(intrinsic / "extrinsic_color.txt");
  if (!X_DC || !X_DR) return Pose::Identity();
  return X_DR->inverse(Eigen::Isometry) * *X_DC;
}

}  // namespace

bool is_scannet_folder(const fs::path& folder) {
  return fs::exists(folder / "intrinsic" / "intrinsic_depth.txt") &&
         !numbered_images(folder / "depth").empty();
}

RecordingContents read_scannet_folder(const fs::path& folder) {
  RecordingContents contents;
  contents.format = "ScanNet export (color, depth, pose, intrinsic)";
  contents.name = name_of(folder);
  contents.remarks.push_back("the images have numbers, not times: mapped at " +
                             std::to_string(kNumberedFrames_Hz) + " frames a second");
  const auto depth = numbered_images(folder / "depth");
  const auto color = numbered_images(folder / "color");
  const fs::path intrinsic = folder / "intrinsic";
  const cv::Size depth_size = size_of_images(files_of(depth));
  if (auto own = own_calibration(folder)) {
    contents.calibration = *own;
  } else {
    contents.calibration = {
        .intrinsics = read_camera_matrix(intrinsic / "intrinsic_depth.txt", depth_size),
        .depth_units_per_m = kUnits_per_m};
  }
  cv::Size color_size = depth_size;
  if (!color.empty()) {
    color_size = size_of_images(files_of(color));
    const Intrinsics camera = read_camera_matrix(intrinsic / "intrinsic_color.txt", color_size);
    contents.color_camera = ColorCamera{.intrinsics = camera, .X_RC = color_X_RC(intrinsic)};
  }
  contents.depth_utimes = times_of(depth);
  contents.color_utimes = times_of(color);
  for (const NumberedImage& image : depth) {
    contents.depth_X_WC.push_back(
        read_pose(folder / "pose" / image.file.filename().replace_extension(".txt")));
  }
  contents.images = std::make_unique<ImageFiles>(
      ImageFiles::Files{.depth = files_of(depth), .color = files_of(color), .confidence = {}},
      depth_size, color_size);
  return contents;
}

}  // namespace kintsugi::mapper
