// Point clouds of other programs, in every format: the contents tell which.

#include <stdexcept>

#include "segmenter/io/formats/cloud_file.hpp"
#include "segmenter/io/points/file_cloud.hpp"
#include "tests/decoder_fuzz/input_file.hpp"
#include "tests/decoder_fuzz/require.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace kintsugi::segmenter;
  const auto path = kintsugi::fuzzing::write_input("cloud", {data, size});
  try {
    const CloudFile file = read_cloud_file(path, LabelUse::kRead);
    // LZF makes at most 88 bytes of one.
    kintsugi::fuzzing::require(file.table.size() <= 88 * size, "each point is in the file");
    const PointRoles roles = find_roles(file.table, "cloud");
    const PositionFrame frame{.metres_per_unit = 0.001,
                              .origin_W = choose_origin_W(file.table, roles, 0.001)};
    cloud_of(file.table, roles, frame, "cloud");
  } catch (const std::runtime_error&) {
  }
  return 0;
}
