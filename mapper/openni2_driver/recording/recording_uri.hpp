#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "mapper/openni2_driver/recording/camera_imitation.hpp"
#include "mapper/openni2_driver/recording/recording.hpp"

namespace kintsugi::mapper {

/// The address of a device of ours: `folder://PATH` or `synthetic://NAME`, either with
/// `?key=value&key=value` (so a folder's path cannot contain a question mark).
struct RecordingUri {
  enum class Scheme { kFolder, kSynthetic };

  Scheme scheme = Scheme::kFolder;
  std::string path;                            ///< PATH or NAME
  CameraImitation imitation;                   ///< from the options of every device
  std::map<std::string, std::string> options;  ///< the others, of synthetic:// only
};

/// nullopt when the scheme is none of ours (another driver's device).
/// @throws std::invalid_argument when it is ours and what follows is not as above.
std::optional<RecordingUri> parse_recording_uri(std::string_view uri);

/// Opens the recording at an address of ours, without the imitation.
/// @throws std::invalid_argument for a bad option, std::runtime_error naming file, line and what
/// was expected when the recording is missing or malformed.
std::unique_ptr<Recording> open_recording(const RecordingUri& uri);

}  // namespace kintsugi::mapper
