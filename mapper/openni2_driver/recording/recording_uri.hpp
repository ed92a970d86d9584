#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "mapper/openni2_driver/recording/camera_imitation.hpp"
#include "mapper/openni2_driver/recording/recording.hpp"

namespace kintsugi::mapper {

/// The address of a device of our driver: `folder://PATH` or `synthetic://NAME`, either with
/// `?key=value&key=value`. The path of a folder therefore cannot contain a question mark.
struct RecordingUri {
  enum class Scheme { kFolder, kSynthetic };

  Scheme scheme = Scheme::kFolder;
  std::string path;                            ///< PATH or NAME
  CameraImitation imitation;                   ///< from the options that every device has
  std::map<std::string, std::string> options;  ///< the other options, only of synthetic://
};

/// nullopt when the scheme is neither folder nor synthetic: the device of another driver.
/// @throws std::invalid_argument when the rest of the address is malformed
std::optional<RecordingUri> parse_recording_uri(std::string_view uri);

/// Opens the recording of an address, without the imitation.
/// @throws std::invalid_argument for a bad option, std::runtime_error naming file, line and what
/// was
///   expected when the recording is missing or malformed
std::unique_ptr<Recording> open_recording(const RecordingUri& uri);

}  // namespace kintsugi::mapper
