#include <array>
#include <fstream>
#include <stdexcept>
#include <string>
#include <utility>

#include <nlohmann/json.hpp>

#include "mapper/openni2_driver/formats/camera_file.hpp"
#include "mapper/openni2_driver/formats/folder_formats.hpp"
#include "mapper/openni2_driver/formats/folder_name.hpp"
#include "mapper/openni2_driver/formats/frame_numbers.hpp"
#include "mapper/openni2_driver/formats/image_files.hpp"
#include "mapper/openni2_driver/formats/numbered_images.hpp"

namespace kintsugi::mapper {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr double kUnits_per_m = 1000.0;

/// What PrimeSense cameras have by default, and what Redwood's recordings are used with.
constexpr Intrinsics kPrimeSense = {.fx = 525.0,
                                    .fy = 525.0,
                                    .cx = 319.5,
                                    .cy = 239.5,
                                    .width = 640,
                                    .height = 480,
                                    .distortion = {}};

std::vector<NumberedImage> color_images(const fs::path& folder) {
  for (const char* name : {"color", "image", "rgb"}) {
    auto images = numbered_images(folder / name);
    if (!images.empty()) return images;
  }
  return {};
}

/// Open3D's PinholeCameraIntrinsic: width, height and the matrix by columns.
std::optional<Calibration> read_json_camera(const fs::path& folder) {
  for (const char* name : {"camera_intrinsic.json", "intrinsic.json", "camera.json"}) {
    const fs::path file = folder / name;
    if (!fs::exists(file)) continue;
    try {
      std::ifstream stream(file);
      const Json json = Json::parse(stream);
      const auto K = json.at("intrinsic_matrix").get<std::array<double, 9>>();
      const Calibration calibration{.intrinsics = {.fx = K[0],
                                                   .fy = K[4],
                                                   .cx = K[6],
                                                   .cy = K[7],
                                                   .width = json.at("width").get<int>(),
                                                   .height = json.at("height").get<int>(),
                                                   .distortion = {}},
                                    .depth_units_per_m = json.value("depth_scale", kUnits_per_m)};
      const Intrinsics& camera = calibration.intrinsics;
      if (!(camera.fx > 0.0 && camera.fy > 0.0 && camera.width > 0 && camera.height > 0 &&
            calibration.depth_units_per_m > 0.0)) {
        throw std::runtime_error(
            "width, height, intrinsic_matrix or depth_scale is not a camera's");
      }
      return calibration;
    } catch (const std::exception& error) {
      throw std::runtime_error(file.string() + ": " + error.what());
    }
  }
  return std::nullopt;
}

Calibration find_calibration(const fs::path& folder, bool named_by_time,
                             std::vector<std::string>& remarks) {
  if (auto own = own_calibration(folder)) return *std::move(own);
  if (auto json = read_json_camera(folder)) return *std::move(json);
  if (!named_by_time) {
    throw std::runtime_error(
        folder.string() +
        ": has numbered images but no camera; write a camera.txt of one line: fx fy cx cy width "
        "height depth_scale [k1 k2 p1 p2 k3]");
  }
  remarks.emplace_back("the camera is a PrimeSense with 525 pixels of focal length, as Redwood's");
  return {.intrinsics = kPrimeSense, .depth_units_per_m = kUnits_per_m};
}

}  // namespace

bool is_numbered_folder(const fs::path& folder) {
  return !numbered_images(folder / "depth").empty();
}

RecordingContents read_numbered_folder(const fs::path& folder) {
  RecordingContents contents;
  contents.name = name_of(folder);
  const auto depth = numbered_images(folder / "depth");
  const auto color = color_images(folder);
  const bool by_time = have_times(depth) && have_times(color);
  contents.format = by_time ? "folder of images named by number and time (Redwood)"
                            : "folder of numbered images (Open3D and others)";
  contents.calibration = find_calibration(folder, by_time, contents.remarks);
  if (!by_time) {
    contents.remarks.push_back("the images have numbers, not times: mapped at " +
                               std::to_string(kNumberedFrames_Hz) + " frames a second");
  }
  contents.depth_utimes = times_of(depth);
  contents.color_utimes = times_of(color);
  const Intrinsics& camera = contents.calibration.intrinsics;
  const cv::Size size(camera.width, camera.height);
  contents.images = std::make_unique<ImageFiles>(
      ImageFiles::Files{.depth = files_of(depth), .color = files_of(color), .confidence = {}}, size,
      size);
  return contents;
}

}  // namespace kintsugi::mapper
