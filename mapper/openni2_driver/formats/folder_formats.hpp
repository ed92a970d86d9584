#pragma once
// Recordings in folders. For each format: whether a folder looks like one, by what is in it, and
// the reader, which looks at lists and names but at no more than the first image.
//
// A camera.txt in the folder counts more than what the format says of its depth camera. Readers
// throw std::runtime_error naming the file, the line if it has lines, and what was expected.

#include <filesystem>

#include "mapper/openni2_driver/formats/recording_contents.hpp"

namespace kintsugi::mapper {

/// The TUM RGB-D benchmark's layout: depth.txt and rgb.txt, or associations.txt. Without camera.txt
/// the camera is known by the name of the benchmark's sequence (fr1, fr2, fr3), or by frame numbers
/// instead of times, which ICL-NUIM's TUM-compatible files have.
bool is_tum_folder(const std::filesystem::path& folder);
RecordingContents read_tum_folder(const std::filesystem::path& folder);

/// A sequence of 7-Scenes: frame-000000.depth.png, .color.png, .pose.txt.
bool is_seven_scenes_folder(const std::filesystem::path& folder);
RecordingContents read_seven_scenes_folder(const std::filesystem::path& folder);

/// What ScanNet's reader exports from a .sens file: color/ depth/ pose/ intrinsic/.
bool is_scannet_folder(const std::filesystem::path& folder);
RecordingContents read_scannet_folder(const std::filesystem::path& folder);

/// The iPhone app Stray Scanner: rgb.mp4 depth/ confidence/ camera_matrix.csv odometry.csv.
bool is_stray_scanner_folder(const std::filesystem::path& folder);
RecordingContents read_stray_scanner_folder(const std::filesystem::path& folder);

/// The iPhone app Record3D, exported as EXR: rgb/ depth/ metadata.json.
bool is_record3d_folder(const std::filesystem::path& folder);
RecordingContents read_record3d_folder(const std::filesystem::path& folder);

/// depth/ and color/, image/ or rgb/ with numbered images: Redwood (NUMBER-MICROSECONDS.png), what
/// Open3D's recorders write (with a .json of the camera), and others with a camera.txt.
bool is_numbered_folder(const std::filesystem::path& folder);
RecordingContents read_numbered_folder(const std::filesystem::path& folder);

}  // namespace kintsugi::mapper
