// Compressed images of a known size.

#include <stdexcept>

#include "mapper/openni2_driver/formats/image_decoder.hpp"
#include "tests/decoder_fuzz/require.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace kintsugi::mapper;  // NOLINT(google-build-using-namespace)
  const cv::Size expected(8, 6);
  try {
    const auto depth = decode_depth({data, size}, expected, "depth");
    kintsugi::fuzzing::require(depth.size() == expected, "the image has the size expected");
  } catch (const std::runtime_error&) {
  }
  try {
    const auto color = decode_color({data, size}, expected, "color");
    kintsugi::fuzzing::require(color.size() == expected, "the image has the size expected");
  } catch (const std::runtime_error&) {
  }
  return 0;
}
