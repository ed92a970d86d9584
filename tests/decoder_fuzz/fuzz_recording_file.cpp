// .klg and .sens files: what is accepted is a recording with a camera and ascending times.

#include <stdexcept>

#include "mapper/openni2_driver/formats/file_formats.hpp"
#include "mapper/openni2_driver/recording/file_recording.hpp"
#include "tests/decoder_fuzz/input_file.hpp"
#include "tests/decoder_fuzz/require.hpp"

namespace {

using kintsugi::fuzzing::require;
using kintsugi::mapper::FileRecording;

void use(FileRecording recording) {
  require(recording.num_depth_frames() > 0, "a recording has depth");
  require(recording.intrinsics().fx > 0.0 && recording.intrinsics().width > 0,
          "a recording has a camera");
  for (int i = 1; i < recording.num_depth_frames(); ++i) {
    require(recording.depth_utime(i) > recording.depth_utime(i - 1), "times ascend");
  }
  (void)recording.depth(0, recording.finest_depth_unit());
  if (recording.num_color_frames() > 0) (void)recording.color(0);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace kintsugi::mapper;  // NOLINT(google-build-using-namespace)
  const auto path = kintsugi::fuzzing::write_input("recording", {data, size});
  try {
    if (is_sens_file(path)) {
      use(FileRecording(read_sens_file(path)));
    } else if (is_klg_file(path)) {
      use(FileRecording(read_klg_file(path, false)));
    }
  } catch (const std::runtime_error&) {
  }
  return 0;
}
