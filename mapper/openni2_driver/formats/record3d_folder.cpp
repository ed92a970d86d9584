#include <array>
#include <cmath>
#include <fstream>
#include <stdexcept>
#include <string>
#include <utility>

#include <nlohmann/json.hpp>

#include "mapper/openni2_driver/formats/camera_file.hpp"
#include "mapper/openni2_driver/formats/folder_formats.hpp"
#include "mapper/openni2_driver/formats/folder_name.hpp"
#include "mapper/openni2_driver/formats/image_files.hpp"
#include "mapper/openni2_driver/formats/numbered_images.hpp"

namespace kintsugi::mapper {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr double kMaxTime_s = 1e12;             // in microseconds far below the end of 64 bits
constexpr double kFinestUnits_per_m = 10000.0;  // of metres in floating point, on the driver's side
constexpr double kUsualRate_hz = 60.0;

struct Metadata {
  Intrinsics camera;  ///< of colour
  double rate_hz = kUsualRate_hz;
  std::vector<double> times_s;
  std::vector<std::array<double, 7>> poses;  ///< qx qy qz qw x y z
};

Metadata read_metadata(const fs::path& file) {
  std::ifstream stream(file);
  try {
    const Json json = Json::parse(stream);
    const auto K = json.at("K").get<std::array<double, 9>>();  // by columns
    Metadata metadata;
    metadata.camera = {.fx = K[0],
                       .fy = K[4],
                       .cx = K[6],
                       .cy = K[7],
                       .width = json.at("w").get<int>(),
                       .height = json.at("h").get<int>(),
                       .distortion = {}};
    metadata.rate_hz = json.value("fps", kUsualRate_hz);
    metadata.times_s = json.value("frameTimestamps", std::vector<double>());
    metadata.poses = json.value("poses", std::vector<std::array<double, 7>>());
    const Intrinsics& camera = metadata.camera;
    if (!(camera.fx > 0.0 && camera.fy > 0.0 && camera.width > 0 && camera.height > 0 &&
          metadata.rate_hz >= 1.0 && metadata.rate_hz <= 1000.0)) {
      throw std::runtime_error("K, w, h or fps is not a camera's");
    }
    return metadata;
  } catch (const std::exception& error) {
    throw std::runtime_error(file.string() + ": " + error.what());
  }
}

/// ARKit's camera has y up and looks along -z.
std::optional<Pose> pose_of(const std::array<double, 7>& values) {
  const Eigen::Quaterniond q(values[3], values[0], values[1], values[2]);
  if (!(std::abs(q.norm() - 1.0) < 0.01)) return std::nullopt;
  Pose X_WA = Pose::Identity();
  X_WA.linear() = q.normalized().toRotationMatrix();
  X_WA.translation() = Eigen::Vector3d(values[4], values[5], values[6]);
  if (!X_WA.matrix().allFinite()) return std::nullopt;
  const Eigen::Matrix3d R_AC = Eigen::Vector3d(1.0, -1.0, -1.0).asDiagonal();
  X_WA.linear() = X_WA.linear() * R_AC;
  return X_WA;
}

/// Microseconds of each frame; where the file has no time, at its rate.
/// @throws std::runtime_error naming a frame when they do not ascend or are out of range
std::vector<std::int64_t> times_of(const std::vector<NumberedImage>& images,
                                   const Metadata& metadata) {
  std::vector<std::int64_t> utimes;
  for (const NumberedImage& image : images) {
    const auto number = static_cast<std::size_t>(image.number);
    const double time_s = number < metadata.times_s.size()
                              ? metadata.times_s[number]
                              : static_cast<double>(image.number) / metadata.rate_hz;
    if (!(time_s >= 0.0 && time_s <= kMaxTime_s)) {
      throw std::runtime_error("frameTimestamps of metadata.json: " + std::to_string(time_s) +
                               " s at frame " + std::to_string(image.number) +
                               ", expected 0 to 1e12 s");
    }
    const std::int64_t utime = std::llround(1e6 * time_s);
    if (!utimes.empty() && utime <= utimes.back()) {
      throw std::runtime_error("frameTimestamps of metadata.json do not ascend at frame " +
                               std::to_string(image.number));
    }
    utimes.push_back(utime);
  }
  return utimes;
}

}  // namespace

bool is_record3d_folder(const fs::path& folder) {
  return fs::exists(folder / "metadata.json") &&
         !numbered_images(folder / "depth", "", ".exr").empty();
}

RecordingContents read_record3d_folder(const fs::path& folder) {
  RecordingContents contents;
  contents.format = "Record3D export (EXR)";
  contents.name = name_of(folder);
  const Metadata metadata = read_metadata(folder / "metadata.json");
  const auto depth = numbered_images(folder / "depth", "", ".exr");
  const auto color = numbered_images(folder / "rgb");
  contents.depth_utimes = times_of(depth, metadata);
  contents.color_utimes = times_of(color, metadata);
  for (const NumberedImage& image : depth) {
    const auto number = static_cast<std::size_t>(image.number);
    contents.depth_X_WC.push_back(number < metadata.poses.size() ? pose_of(metadata.poses[number])
                                                                 : std::nullopt);
  }
  const cv::Size size = size_of_images(files_of(depth));
  const cv::Size color_size(metadata.camera.width, metadata.camera.height);
  contents.calibration = own_calibration(folder).value_or(Calibration{
      .intrinsics = scaled(metadata.camera, size), .depth_units_per_m = kFinestUnits_per_m});
  if (!color.empty()) {
    contents.color_camera = beside(contents.calibration.intrinsics, metadata.camera);
  }
  contents.images = std::make_unique<ImageFiles>(
      ImageFiles::Files{.depth = files_of(depth), .color = files_of(color), .confidence = {}}, size,
      color_size);
  return contents;
}

}  // namespace kintsugi::mapper
