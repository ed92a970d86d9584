// Clouds that the mapper writes: as a PLY file, and as a log of slices.

#include <stdexcept>

#include "mapper/output/cloud_reader.hpp"
#include "tests/decoder_fuzz/input_file.hpp"
#include "tests/decoder_fuzz/require.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  for (const char* name : {"cloud.ply", "cloud.log"}) {
    const auto path = kintsugi::fuzzing::write_input(name, {data, size});
    try {
      const auto points_W = kintsugi::mapper::read_cloud(path);
      kintsugi::fuzzing::require(points_W.size() * 31 <= size, "each point is in the file");
    } catch (const std::runtime_error&) {
    }
  }
  return 0;
}
