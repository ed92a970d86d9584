#include "mapper/openni2_driver/recording/recording_uri.hpp"

#include <algorithm>
#include <stdexcept>

#include "mapper/openni2_driver/recording/file_recording.hpp"
#include "mapper/openni2_driver/recording/synthetic_recording.hpp"

namespace kintsugi::mapper {
namespace {

constexpr std::string_view kRecordingScheme = "recording://";
constexpr std::string_view kFolderScheme = "folder://";
constexpr std::string_view kSyntheticScheme = "synthetic://";

std::map<std::string, std::string> parse_options(std::string_view uri, std::string_view query) {
  std::map<std::string, std::string> options;
  while (!query.empty()) {
    const std::string_view option = query.substr(0, query.find('&'));
    query.remove_prefix(std::min(option.size() + 1, query.size()));
    const std::size_t equals = option.find('=');
    if (equals == 0 || equals == std::string_view::npos) {
      throw std::invalid_argument(std::string(uri) + ": option '" + std::string(option) +
                                  "', expected key=value");
    }
    const bool is_new = options.emplace(option.substr(0, equals), option.substr(equals + 1)).second;
    if (!is_new) {
      throw std::invalid_argument(std::string(uri) + ": option '" +
                                  std::string(option.substr(0, equals)) + "' is given twice");
    }
  }
  return options;
}

}  // namespace

std::string recording_address(const std::filesystem::path& path) {
  return std::string(kRecordingScheme) + path.string();
}

std::optional<RecordingUri> parse_recording_uri(std::string_view uri) {
  RecordingUri result;
  std::string_view rest;
  for (const std::string_view scheme : {kRecordingScheme, kFolderScheme, kSyntheticScheme}) {
    if (!uri.starts_with(scheme)) continue;
    rest = uri.substr(scheme.size());
    result.scheme = scheme == kSyntheticScheme ? RecordingUri::Scheme::kSynthetic
                                               : RecordingUri::Scheme::kRecording;
  }
  if (rest.data() == nullptr) return std::nullopt;
  const std::size_t question = rest.find('?');
  result.path = rest.substr(0, question);
  if (question != std::string_view::npos) {
    result.options = parse_options(uri, rest.substr(question + 1));
  }
  if (result.path.empty()) {
    throw std::invalid_argument(std::string(uri) +
                                ": nothing after the scheme, expected recording://PATH, "
                                "folder://PATH or synthetic://NAME");
  }
  result.imitation = CameraImitation::take_from(result.options);
  if (result.scheme == RecordingUri::Scheme::kSynthetic) return result;
  result.reading = ReadingOptions::take_from(result.options);
  if (!result.options.empty()) {
    throw std::invalid_argument(std::string(uri) + ": no option '" + result.options.begin()->first +
                                "'; there are: " + ReadingOptions::known_options() + " " +
                                CameraImitation::known_options());
  }
  return result;
}

std::unique_ptr<Recording> open_recording(const RecordingUri& uri) {
  if (uri.scheme == RecordingUri::Scheme::kRecording) {
    return std::make_unique<FileRecording>(read_recording(uri.path, uri.reading));
  }
  try {
    return std::make_unique<SyntheticRecording>(
        synthetic::Sequence::Config::parse(uri.path, uri.options));
  } catch (const std::invalid_argument& error) {
    if (uri.options.empty()) throw;
    throw std::invalid_argument(std::string(error.what()) +
                                " (and of every device: " + CameraImitation::known_options() + ")");
  }
}

}  // namespace kintsugi::mapper
