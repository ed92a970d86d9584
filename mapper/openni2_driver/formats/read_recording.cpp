#include "mapper/openni2_driver/formats/read_recording.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <system_error>
#include <vector>

#include "mapper/openni2_driver/formats/file_formats.hpp"
#include "mapper/openni2_driver/formats/folder_formats.hpp"

namespace kintsugi::mapper {
namespace {

namespace fs = std::filesystem;

struct FolderFormat {
  bool (*is_one)(const fs::path& folder);
  RecordingContents (*read)(const fs::path& folder);
};

/// In this order: a folder may look like several, as one that was converted.
constexpr std::array<FolderFormat, 6> kFolderFormats = {
    {{is_tum_folder, read_tum_folder},
     {is_seven_scenes_folder, read_seven_scenes_folder},
     {is_stray_scanner_folder, read_stray_scanner_folder},
     {is_record3d_folder, read_record3d_folder},
     {is_scannet_folder, read_scannet_folder},
     {is_numbered_folder, read_numbered_folder}}};

const FolderFormat* format_of(const fs::path& folder) {
  const auto* const format = std::ranges::find_if(
      kFolderFormats, [&](const FolderFormat& each) { return each.is_one(folder); });
  return format == kFolderFormats.end() ? nullptr : format;
}

/// A hint for who names the folder above.
std::string recordings_inside(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(folder, none)) {
    if (entry.is_directory(none) && format_of(entry.path()) != nullptr) {
      names.push_back(entry.path().filename().string());
    }
  }
  if (names.empty()) return "";
  std::ranges::sort(names);
  std::string text = "; there are recordings in the folders in it:";
  for (const std::string& name : names) text += " " + name;
  return text;
}

RecordingContents read_folder(const fs::path& folder) {
  if (const FolderFormat* format = format_of(folder)) return format->read(folder);
  throw std::runtime_error(
      folder.string() +
      ": no recording that is known; expected a folder as of TUM (depth.txt), ICL-NUIM "
      "(associations.txt), 7-Scenes (frame-000000.depth.png), ScanNet (depth/ intrinsic/), Stray "
      "Scanner (odometry.csv), Record3D (metadata.json), Redwood or Open3D (depth/)" +
      recordings_inside(folder));
}

}  // namespace

ReadingOptions ReadingOptions::take_from(std::map<std::string, std::string>& options) {
  ReadingOptions result;
  const auto take = [&](const char* key) {
    const auto node = options.extract(key);
    return node.empty() ? std::string() : node.mapped();
  };
  result.depth_topic = take("depth_topic");
  result.color_topic = take("color_topic");
  const std::string swap = take("swap_colors");
  if (!swap.empty() && swap != "on" && swap != "off") {
    throw std::invalid_argument("option swap_colors is '" + swap + "', expected on or off");
  }
  result.swap_colors = swap == "on";
  return result;
}

std::string ReadingOptions::known_options() {
  return "depth_topic=TOPIC color_topic=TOPIC (of a ROS bag) swap_colors=on|off (of a .klg)";
}

RecordingContents read_recording(const fs::path& path, const ReadingOptions& options) {
  if (!fs::exists(path)) throw std::runtime_error(path.string() + ": no such file or folder");
  if (fs::is_directory(path)) return read_folder(path);
  if (is_ros_bag(path)) {
    return read_ros_bag(path, {.depth = options.depth_topic, .color = options.color_topic});
  }
  if (is_sens_file(path)) return read_sens_file(path);
  if (is_klg_file(path)) return read_klg_file(path, options.swap_colors);
  throw std::runtime_error(path.string() +
                           ": no recording that is known; expected an .oni file of OpenNI2, a .klg "
                           "of Kintinuous or ElasticFusion, a .sens of ScanNet or a .bag of ROS 1");
}

}  // namespace kintsugi::mapper
