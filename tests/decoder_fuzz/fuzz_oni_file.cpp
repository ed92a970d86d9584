// A .oni recording: read to its end; a repaired copy of a damaged one has the expected frames.

#include <stdexcept>

#include "mapper/source/openni2/oni_file.hpp"
#include "tests/decoder_fuzz/input_file.hpp"
#include "tests/decoder_fuzz/require.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace kintsugi::mapper;  // NOLINT(google-build-using-namespace)
  using kintsugi::fuzzing::require;
  using Kind = OniFile::Node::Kind;
  const auto path = kintsugi::fuzzing::write_input("recording.oni", {data, size});
  try {
    const OniFile contents = scan_oni_file(path);
    require(contents.good_bytes <= size, "what is good lies in the file");
    if (contents.damage.empty() || !contents.can_be_mended) return 0;
    const auto copy = kintsugi::fuzzing::input_folder() / "copy.oni";
    write_mended_copy(path, contents, copy);
    const OniFile mended = scan_oni_file(copy);
    require(mended.damage.empty(), "a mended copy is whole");
    require(mended.frames(Kind::kDepth) == contents.frames(Kind::kDepth),
            "a mended copy has the frames that were whole");
  } catch (const std::runtime_error&) {
  }
  return 0;
}
