// Addresses of our own devices.

#include <stdexcept>

#include "mapper/openni2_driver/recording/recording_uri.hpp"
#include "mapper/synthetic/render/sequence.hpp"
#include "tests/decoder_fuzz/input_file.hpp"
#include "tests/decoder_fuzz/require.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const auto uri =
        kintsugi::mapper::parse_recording_uri(kintsugi::fuzzing::as_text({data, size}));
    if (!uri) return 0;
    kintsugi::fuzzing::require(!uri->path.empty(), "an address names something");
    (void)kintsugi::synthetic::Sequence::Config::parse(uri->path, uri->options);
  } catch (const std::invalid_argument&) {
  }
  return 0;
}
