// A saved segment map: what is accepted is a valid map, and is written again with the same bytes.

#include <stdexcept>

#include "segmenter/io/saved_map.hpp"
#include "tests/decoder_fuzz/input_file.hpp"
#include "tests/decoder_fuzz/require.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace kintsugi::segmenter;  // NOLINT(google-build-using-namespace)
  const auto path = kintsugi::fuzzing::write_input("map", {data, size});
  try {
    const SegmentMapState state = read_map_state(path);
    const auto again = kintsugi::fuzzing::input_folder() / "again";
    write_map_state(state, again);
    kintsugi::fuzzing::require(
        kintsugi::fuzzing::contents(again) == kintsugi::fuzzing::as_text({data, size}),
        "a map is the same when it is saved again");
    (void)make_map(state, path);
  } catch (const std::runtime_error&) {
  }
  return 0;
}
