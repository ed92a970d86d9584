#pragma once
// A synthetic sequence as a folder of images.

#include <filesystem>
#include <string>
#include <vector>

#include "mapper/synthetic/render/sequence.hpp"

namespace kintsugi::synthetic {

/// Frames first, first + step, ... below end.
struct FrameRange {
  int first = 0;
  int end = 0;
  int step = 1;

  /// "a:b:step", "a:b", or "" for all of `count`; b may be left out.
  /// @throws std::invalid_argument if it is malformed, empty, or outside 0 to count
  static FrameRange parse(const std::string& text, int count);
};

/// Writes a folder in the layout of the TUM benchmark, image by image:
///   depth/SECONDS.png     16-bit millimetres with the noise of the sensor; 0: invalid
///   rgb/SECONDS.png
///   normals/SECONDS.png   true normal in W, 8 bits a channel: red = 127.5 (1 + nx), ...; 0: none
///   instances/SECONDS.png true instance, 16 bit, 0: none
/// and at the end associations.txt, depth.txt, rgb.txt, camera.txt,
/// groundtruth.txt and instances.json (the last three for the whole sequence).
class FolderWriter {
 public:
  /// Creates the folders.
  /// @throws std::filesystem::filesystem_error
  FolderWriter(Sequence& sequence, std::filesystem::path folder);

  /// @throws std::system_error naming the file that could not be written
  void write_frame(int frame);

  /// Writes the lists of the images, and the ground truth.
  void finish();

 private:
  Sequence& sequence_;
  std::filesystem::path folder_;
  std::vector<std::string> seconds_;  // of the frames written
};

}  // namespace kintsugi::synthetic
