#pragma once
// The writers of open_recording_writer(), one for each format.

#include <filesystem>
#include <memory>

#include "mapper/conversion/recording_writer.hpp"

namespace kintsugi::mapper {

/// depth/ (16-bit PNG, 0.2 mm as the benchmark's), rgb/ (PNG), depth.txt, rgb.txt, camera.txt and,
/// with poses, groundtruth.txt. Depth beyond 13.1 m is left out.
std::unique_ptr<RecordingWriter> make_tum_writer(const std::filesystem::path& folder);

/// Depth in millimetres, compressed with zlib; colour as JPEG, or raw without loss. Poses and the
/// camera have no place in it: the camera is written beside it, to FILE.camera.txt, where our
/// reader looks for it.
std::unique_ptr<RecordingWriter> make_klg_writer(const std::filesystem::path& file,
                                                 const WritingOptions& options);

/// RGBD_FRAME of a session of its own. Poses have no place in it.
std::unique_ptr<RecordingWriter> make_frame_log_writer(const std::filesystem::path& file,
                                                       const WritingOptions& options);

}  // namespace kintsugi::mapper
