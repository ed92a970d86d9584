// The files of a recording in TUM layout. The input is depth.txt, rgb.txt and associations.txt with
// a zero byte between them; an empty file does not exist. The images 0 to 2 exist.

#include <algorithm>
#include <array>
#include <filesystem>
#include <stdexcept>

#include <opencv2/imgcodecs.hpp>

#include "mapper/openni2_driver/formats/folder_formats.hpp"
#include "mapper/openni2_driver/recording/file_recording.hpp"
#include "tests/decoder_fuzz/input_file.hpp"
#include "tests/decoder_fuzz/require.hpp"

namespace {

namespace fs = std::filesystem;
using kintsugi::fuzzing::input_folder;

/// The files that every input uses.
bool make_folder() {
  fs::create_directories(input_folder() / "depth");
  fs::create_directories(input_folder() / "rgb");
  for (const char* name : {"0.png", "1.png", "2.png"}) {
    cv::imwrite((input_folder() / "depth" / name).string(), cv::Mat_<std::uint16_t>(3, 4, 1'000));
    cv::imwrite((input_folder() / "rgb" / name).string(), cv::Mat_<cv::Vec3b>(3, 4, cv::Vec3b()));
  }
  std::ofstream(input_folder() / "camera.txt") << "5 5 1.5 1 4 3 1000\n";
  return true;
}

void write_lists(std::span<const std::uint8_t> input) {
  for (const char* name : {"depth.txt", "rgb.txt", "associations.txt"}) {
    const auto end = std::find(input.begin(), input.end(), 0);
    const auto size = static_cast<std::size_t>(end - input.begin());
    if (size > 0) {
      kintsugi::fuzzing::write_input(name, input.first(size));
    } else {
      fs::remove(input_folder() / name);
    }
    input = input.subspan(std::min(size + 1, input.size()));
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace kintsugi::mapper;  // NOLINT(google-build-using-namespace)
  [[maybe_unused]] static const bool made = make_folder();
  write_lists({data, size});
  try {
    FileRecording recording(read_tum_folder(input_folder().path()));
    kintsugi::fuzzing::require(recording.num_depth_frames() > 0, "a recording has depth");
    kintsugi::fuzzing::require(recording.frame_rate_hz() > 0, "a recording has a rate");
    (void)recording.depth(0, recording.finest_depth_unit());
    if (recording.num_color_frames() > 0) (void)recording.color(0);
  } catch (const std::runtime_error&) {
  }
  return 0;
}
