#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "mapper/openni2_driver/formats/read_recording.hpp"
#include "mapper/openni2_driver/recording/camera_imitation.hpp"
#include "mapper/openni2_driver/recording/recording.hpp"

namespace kintsugi::mapper {

/// The address of a device of our driver: `recording://PATH`, of a file or a folder
/// (`folder://PATH` is the same), or `synthetic://NAME`; with `?key=value&key=value`. The path
/// therefore cannot contain a question mark.
struct RecordingUri {
  enum class Scheme { kRecording, kSynthetic };

  Scheme scheme = Scheme::kRecording;
  std::string path;                            ///< PATH or NAME
  ReadingOptions reading;                      ///< only of recording://
  CameraImitation imitation;                   ///< from the options that every device has
  std::map<std::string, std::string> options;  ///< the other options, only of synthetic://
};

/// What `recording://PATH` is for a path.
std::string recording_address(const std::filesystem::path& path);

/// nullopt when the scheme is none of these: the device of another driver.
/// @throws std::invalid_argument when the rest of the address is malformed
std::optional<RecordingUri> parse_recording_uri(std::string_view uri);

/// Opens the recording of an address, without the imitation.
/// @throws std::invalid_argument for a bad option, std::runtime_error naming file, line and what
/// was
///   expected when the recording is missing or malformed
std::unique_ptr<Recording> open_recording(const RecordingUri& uri);

}  // namespace kintsugi::mapper
