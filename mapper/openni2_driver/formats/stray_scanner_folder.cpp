#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>

#include "mapper/openni2_driver/formats/camera_file.hpp"
#include "mapper/openni2_driver/formats/folder_formats.hpp"
#include "mapper/openni2_driver/formats/folder_name.hpp"
#include "mapper/openni2_driver/formats/image_files.hpp"
#include "mapper/openni2_driver/formats/numbered_images.hpp"
#include "mapper/openni2_driver/formats/text_file.hpp"
#include "mapper/openni2_driver/formats/video_file.hpp"

namespace kintsugi::mapper {
namespace {

namespace fs = std::filesystem;

constexpr double kMaxFrame = 1e9;  // 100 days at 100 Hz

constexpr double kUnits_per_m = 1000.0;
const cv::Size kPhoneVideo(1920, 1440);  // of camera_matrix.csv, when there is no video

struct OdometryLine {
  std::int64_t utime = 0;
  std::optional<Pose> X_WC;
};

std::vector<std::string> split_at_commas(const TextLine& line) {
  std::vector<std::string> fields;
  for (const std::string& word : line.words) {
    for (std::size_t start = 0; start < word.size();) {
      const std::size_t end = std::min(word.find(',', start), word.size());
      if (end > start) fields.push_back(word.substr(start, end - start));
      start = end + 1;
    }
  }
  return fields;
}

std::optional<Pose> pose_of(const std::vector<std::string>& fields) {
  std::array<double, 7> values{};  // x y z qx qy qz qw
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto value = parse_number(fields.at(2 + i));
    if (!value) return std::nullopt;
    values.at(i) = *value;
  }
  const Eigen::Quaterniond q(values[6], values[3], values[4], values[5]);
  if (std::abs(q.norm() - 1.0) > 0.01) return std::nullopt;
  Pose pose = Pose::Identity();
  pose.linear() = q.normalized().toRotationMatrix();
  pose.translation() = Eigen::Vector3d(values[0], values[1], values[2]);
  return pose;
}

/// Time and pose by the number of the frame. The first line is a header.
std::map<std::int64_t, OdometryLine> read_odometry(const fs::path& file) {
  std::map<std::int64_t, OdometryLine> frames;
  const std::vector<TextLine> lines = read_text_lines(file);
  for (std::size_t i = 1; i < lines.size(); ++i) {
    const std::vector<std::string> fields = split_at_commas(lines[i]);
    const auto number = fields.size() < 9 ? std::nullopt : parse_number(fields[1]);
    const auto utime = fields.size() < 9 ? std::nullopt : parse_seconds(fields[0]);
    const bool is_frame =
        number && *number >= 0.0 && *number <= kMaxFrame && *number == std::floor(*number);
    if (!is_frame || !utime) {
      throw std::runtime_error(place(file, lines[i].number) +
                               "expected timestamp, frame, x, y, z, qx, qy, qz, qw");
    }
    frames[static_cast<std::int64_t>(*number)] = {*utime, pose_of(fields)};
  }
  return frames;
}

/// Depth and confidence in files, colour in a video.
class PhoneImages : public ImageStore {
 public:
  PhoneImages(ImageFiles depth, std::optional<VideoFile> video, std::vector<int> pictures)
      : depth_(std::move(depth)), video_(std::move(video)), pictures_(std::move(pictures)) {}

  [[nodiscard]] cv::Mat depth(int index) override { return depth_.depth(index); }
  [[nodiscard]] cv::Mat_<cv::Vec3b> color(int index) override {
    return video_.value().picture(pictures_.at(static_cast<std::size_t>(index)));
  }
  [[nodiscard]] bool depth_is_missing(int index) const override {
    return depth_.depth_is_missing(index);
  }

 private:
  ImageFiles depth_;
  std::optional<VideoFile> video_;
  std::vector<int> pictures_;  ///< of the video, by colour image
};

std::optional<VideoFile> open_video(const fs::path& folder, std::vector<std::string>& remarks) {
  try {
    if (fs::exists(folder / "rgb.mp4")) return VideoFile(folder / "rgb.mp4");
    remarks.emplace_back("there is no rgb.mp4, so there is no colour");
  } catch (const std::runtime_error& error) {
    remarks.push_back("there is no colour: " + std::string(error.what()));
  }
  return std::nullopt;
}

}  // namespace

bool is_stray_scanner_folder(const fs::path& folder) {
  return fs::exists(folder / "camera_matrix.csv") && fs::exists(folder / "odometry.csv");
}

RecordingContents read_stray_scanner_folder(const fs::path& folder) {
  RecordingContents contents;
  contents.format = "Stray Scanner recording";
  contents.name = name_of(folder);
  auto video = open_video(folder, contents.remarks);
  const auto odometry = read_odometry(folder / "odometry.csv");
  ImageFiles::Files files;
  std::vector<int> pictures;
  int num_without_line = 0;
  for (const NumberedImage& image : numbered_images(folder / "depth", "", ".png")) {
    const auto frame = odometry.find(image.number);
    if (frame == odometry.end()) {
      ++num_without_line;
      continue;
    }
    const std::int64_t utime = frame->second.utime;
    if (!contents.depth_utimes.empty() && utime <= contents.depth_utimes.back()) {
      throw std::runtime_error((folder / "odometry.csv").string() + ": the time of frame " +
                               std::to_string(image.number) + " is not after that before it");
    }
    contents.depth_utimes.push_back(utime);
    contents.depth_X_WC.push_back(frame->second.X_WC);
    files.depth.push_back(image.file);
    pictures.push_back(static_cast<int>(image.number));
    const fs::path confidence = folder / "confidence" / image.file.filename();
    if (fs::exists(confidence)) files.confidence.push_back(confidence);
  }
  if (num_without_line > 0) {
    contents.remarks.push_back(std::to_string(num_without_line) +
                               " depth images are left out, because odometry.csv has no line of "
                               "them");
  }
  if (files.depth.empty()) {
    throw std::runtime_error((folder / "depth").string() +
                             ": no depth image (.png) of which odometry.csv has the time");
  }
  if (files.confidence.size() != files.depth.size()) {
    if (!files.confidence.empty()) {
      contents.remarks.emplace_back("the confidence is not used: it is not there for all images");
    }
    files.confidence.clear();
  }
  const cv::Size size = size_of_images(files.depth);
  const Intrinsics color_camera =
      read_camera_matrix(folder / "camera_matrix.csv", video ? video->size() : kPhoneVideo);
  contents.calibration = own_calibration(folder).value_or(
      Calibration{.intrinsics = scaled(color_camera, size), .depth_units_per_m = kUnits_per_m});
  if (video) {
    contents.color_utimes = contents.depth_utimes;
    contents.color_camera = beside(contents.calibration.intrinsics, color_camera);
  }
  contents.images = std::make_unique<PhoneImages>(ImageFiles(std::move(files), size, size),
                                                  std::move(video), std::move(pictures));
  return contents;
}

}  // namespace kintsugi::mapper
