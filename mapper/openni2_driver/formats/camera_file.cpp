#include "mapper/openni2_driver/formats/camera_file.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "mapper/openni2_driver/formats/text_file.hpp"

namespace kintsugi::mapper {
namespace {

namespace fs = std::filesystem;

/// The numbers of a line; a word may have several, separated by commas.
std::vector<double> numbers_in(const TextLine& line, const fs::path& file) {
  std::vector<double> numbers;
  for (const std::string& word : line.words) {
    for (std::size_t start = 0; start < word.size();) {
      const std::size_t end = std::min(word.find(',', start), word.size());
      const std::string number = word.substr(start, end - start);
      start = end + 1;
      if (number.empty()) continue;
      const auto value = parse_number(number);
      if (!value) {
        throw std::runtime_error(place(file, line.number) + "'" + number +
                                 "' is not a finite number");
      }
      numbers.push_back(*value);
    }
  }
  return numbers;
}

}  // namespace

std::optional<Calibration> own_calibration(const fs::path& folder) {
  const fs::path file = folder / "camera.txt";
  if (!fs::exists(file)) return std::nullopt;
  return read_calibration(file);
}

fs::path calibration_file_beside(const fs::path& file) { return file.string() + ".camera.txt"; }

std::optional<Calibration> calibration_beside(const fs::path& file) {
  const fs::path beside = calibration_file_beside(file);
  if (!fs::exists(beside)) return std::nullopt;
  return read_calibration(beside);
}

Intrinsics read_camera_matrix(const fs::path& file, cv::Size size) {
  const std::vector<TextLine> lines = read_text_lines(file);
  if (lines.size() < 3) throw std::runtime_error(file.string() + ": expected a 3x3 matrix");
  std::vector<std::vector<double>> rows;
  for (std::size_t row = 0; row < 3; ++row) {
    rows.push_back(numbers_in(lines[row], file));
    if (rows.back().size() < 3) {
      throw std::runtime_error(place(file, lines[row].number) + "expected a row of a 3x3 matrix");
    }
  }
  const Intrinsics camera{.fx = rows[0][0],
                          .fy = rows[1][1],
                          .cx = rows[0][2],
                          .cy = rows[1][2],
                          .width = size.width,
                          .height = size.height,
                          .distortion = {}};
  if (camera.fx <= 0.0 || camera.fy <= 0.0) {
    throw std::runtime_error(file.string() + ": the focal lengths are " +
                             std::to_string(camera.fx) + " and " + std::to_string(camera.fy) +
                             ", expected numbers greater than 0");
  }
  return camera;
}

std::optional<Pose> rigid(const Eigen::Matrix4d& matrix) {
  constexpr double kTolerance = 0.01;
  if (!matrix.allFinite() || matrix.row(3) != Eigen::RowVector4d(0.0, 0.0, 0.0, 1.0)) {
    return std::nullopt;
  }
  const Eigen::Matrix3d R = matrix.topLeftCorner<3, 3>();
  const bool is_rotation = (R * R.transpose() - Eigen::Matrix3d::Identity()).norm() < kTolerance &&
                           R.determinant() > 0.0;
  if (!is_rotation || matrix.topRightCorner<3, 1>().norm() > kMaxPosition_m) return std::nullopt;
  Pose pose = Pose::Identity();
  pose.linear() = Eigen::Quaterniond(R).normalized().toRotationMatrix();
  pose.translation() = matrix.topRightCorner<3, 1>();
  return pose;
}

std::optional<Pose> read_pose(const fs::path& file) {
  try {
    const std::vector<TextLine> lines = read_text_lines(file);
    if (lines.size() != 4) return std::nullopt;
    Eigen::Matrix4d matrix;
    for (int row = 0; row < 4; ++row) {
      const std::vector<double> numbers = numbers_in(lines[static_cast<std::size_t>(row)], file);
      if (numbers.size() != 4) return std::nullopt;
      matrix.row(row) = Eigen::Map<const Eigen::RowVector4d>(numbers.data());
    }
    return rigid(matrix);
  } catch (const std::runtime_error&) {
    return std::nullopt;
  }
}

Intrinsics scaled(const Intrinsics& camera, cv::Size size) {
  const double x = static_cast<double>(size.width) / camera.width;
  const double y = static_cast<double>(size.height) / camera.height;
  return {.fx = x * camera.fx,
          .fy = y * camera.fy,
          .cx = x * (camera.cx + 0.5) - 0.5,
          .cy = y * (camera.cy + 0.5) - 0.5,
          .width = size.width,
          .height = size.height,
          .distortion = camera.distortion};
}

std::optional<ColorCamera> beside(const Intrinsics& depth, const Intrinsics& color) {
  if (depth == color) return std::nullopt;
  return ColorCamera{.intrinsics = color, .X_RC = Pose::Identity()};
}

}  // namespace kintsugi::mapper
