// camera.txt: what is accepted is a valid camera.

#include <cmath>
#include <stdexcept>

#include "mapper/openni2_driver/formats/calibration.hpp"
#include "tests/decoder_fuzz/input_file.hpp"
#include "tests/decoder_fuzz/require.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto path = kintsugi::fuzzing::write_input("camera.txt", {data, size});
  try {
    const auto calibration = kintsugi::mapper::read_calibration(path);
    kintsugi::fuzzing::require(
        calibration.intrinsics.fx > 0.0 && std::isfinite(calibration.intrinsics.fx) &&
            calibration.intrinsics.width > 0 && calibration.intrinsics.height > 0,
        "a camera has a focal length and an image");
  } catch (const std::runtime_error&) {
  }
  return 0;
}
