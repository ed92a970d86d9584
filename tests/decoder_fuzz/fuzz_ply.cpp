// PLY files of other programs.

#include <stdexcept>

#include "segmenter/io/ply/ply_reader.hpp"
#include "tests/decoder_fuzz/input_file.hpp"
#include "tests/decoder_fuzz/require.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto text = kintsugi::fuzzing::as_text({data, size});
  try {
    const auto cloud = kintsugi::segmenter::parse_ply(text, "input");
    kintsugi::fuzzing::require(cloud.points_W.size() * 6 <= size, "each point is in the file");
  } catch (const std::runtime_error&) {
  }
  return 0;
}
