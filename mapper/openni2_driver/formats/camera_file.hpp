#pragma once
// Cameras and poses in the small text files that recordings in folders have beside their images.

#include <filesystem>
#include <optional>

#include <opencv2/core.hpp>

#include "lcmtypes/geometry.hpp"
#include "mapper/openni2_driver/formats/calibration.hpp"
#include "mapper/openni2_driver/formats/recording_contents.hpp"

namespace kintsugi::mapper {

/// The folder's own camera.txt, if there is one.
/// @throws std::runtime_error as read_calibration()
std::optional<Calibration> own_calibration(const std::filesystem::path& folder);

/// The camera of a file FILE that has none in it: FILE.camera.txt, if there is one.
/// @throws std::runtime_error as read_calibration()
std::optional<Calibration> calibration_beside(const std::filesystem::path& file);
/// Where calibration_beside() looks, and kintsugi-convert writes.
std::filesystem::path calibration_file_beside(const std::filesystem::path& file);

/// A matrix of at least 3 x 3 numbers, one row a line, separated by blanks or commas, with the
/// focal lengths and the principal point of images of `size`.
/// @throws std::runtime_error naming file, line and what was expected
Intrinsics read_camera_matrix(const std::filesystem::path& file, cv::Size size);

/// A pose as 4 lines of 4 numbers; nullopt when the file is not there, or is no rigid motion, as
/// where the camera was lost (-inf).
std::optional<Pose> read_pose(const std::filesystem::path& file);

/// The pose nearest to a matrix that is nearly one; nullopt when it is none, to 1 %.
std::optional<Pose> rigid(const Eigen::Matrix4d& matrix);

/// The same camera with images of another size that show the same view.
Intrinsics scaled(const Intrinsics& camera, cv::Size size);

/// A colour camera at the place of the depth camera; nothing when its pixels are the same.
std::optional<ColorCamera> beside(const Intrinsics& depth, const Intrinsics& color);

}  // namespace kintsugi::mapper
