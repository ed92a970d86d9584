#pragma once
// A recording in which the camera is suddenly in another room: nothing there matches the map.

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "mapper/synthetic/render/folder_writer.hpp"
#include "mapper/synthetic/render/sequence.hpp"

namespace kintsugi::mapper::testing {

inline constexpr int kFramesInEachRoom = 16;  ///< 30 a second

/// Writes the recording into `folder`. The frames of the second room follow those of the first at
/// the same rate.
inline void write_two_rooms(const std::filesystem::path& folder) {
  std::string list;
  for (const int room : {0, 1}) {
    synthetic::Sequence::Config config;
    config.scene = room == 0 ? "office" : "loop";
    synthetic::Sequence sequence(config);
    synthetic::FolderWriter writer(sequence, folder);
    const int begin = room * kFramesInEachRoom;
    for (int i = begin; i < begin + kFramesInEachRoom; ++i) writer.write_frame(i);
    writer.finish();
    std::ostringstream text;
    text << std::ifstream(folder / "associations.txt").rdbuf();
    list += text.str();
  }
  std::ofstream(folder / "associations.txt") << list;
  for (const char* other : {"depth.txt", "rgb.txt"}) std::filesystem::remove(folder / other);
}

/// Flags that map it in two parts. The second begins 0.2 s after the change.
inline std::vector<std::string> map_two_rooms(const std::filesystem::path& folder) {
  return {"--device",        "folder://" + folder.string(),
          "--restart-after", "0.2",
          "--volume-size",   "4",
          "--resolution",    "0.02",
          "--session",       "7",
          "--linger",        "0",
          "--replay"};
}

}  // namespace kintsugi::mapper::testing
