#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "mapper/openni2_driver/formats/recording_contents.hpp"

namespace kintsugi::mapper {

/// How to read what the recording does not say; keys of a recording's address.
struct ReadingOptions {
  std::string depth_topic;   ///< depth_topic=TOPIC, of a ROS bag; empty: guessed
  std::string color_topic;   ///< color_topic=TOPIC
  bool swap_colors = false;  ///< swap_colors=on, of a .klg: red and blue change places

  /// Takes the keys of this kind out of `options`.
  /// @throws std::invalid_argument naming key, value and what was expected
  static ReadingOptions take_from(std::map<std::string, std::string>& options);

  /// Every key with its values, for messages.
  static std::string known_options();
};

/// Reads a recording of any known format; which one is found by what is in it.
/// @throws std::runtime_error naming the file or folder, what is wrong with it or which formats
///   there are, and the recordings in folders of it, if it has such
RecordingContents read_recording(const std::filesystem::path& path, const ReadingOptions& options);

}  // namespace kintsugi::mapper
