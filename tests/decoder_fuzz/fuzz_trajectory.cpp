// A trajectory in the TUM format: what is accepted can be written and read again.

#include <sstream>
#include <stdexcept>
#include <string>

#include "lcmtypes/trajectory.hpp"
#include "tests/decoder_fuzz/input_file.hpp"
#include "tests/decoder_fuzz/require.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::istringstream in{std::string(kintsugi::fuzzing::as_text({data, size}))};
  kintsugi::Trajectory trajectory;
  try {
    trajectory = kintsugi::read_tum(in, "input");
  } catch (const std::runtime_error&) {
    return 0;
  }
  (void)kintsugi::pose_at(trajectory, trajectory.front().utime + 1);
  std::stringstream written;
  kintsugi::write_tum(written, trajectory);
  const auto again = kintsugi::read_tum(written, "written");
  kintsugi::fuzzing::require(
      again.size() == trajectory.size() && again.back().utime == trajectory.back().utime,
      "a trajectory keeps its poses and times");
  return 0;
}
