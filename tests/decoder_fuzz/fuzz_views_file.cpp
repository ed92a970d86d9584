// Views beside a saved map: what is accepted can be unpacked, and is written again with the same
// bytes.

#include <optional>
#include <stdexcept>

#include "segmenter/io/views_file.hpp"
#include "tests/decoder_fuzz/input_file.hpp"
#include "tests/decoder_fuzz/require.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace kintsugi::segmenter;  // NOLINT(google-build-using-namespace)
  const auto path = kintsugi::fuzzing::write_input("map.views", {data, size});
  try {
    const ViewSet views = read_views(path);
    const auto again = kintsugi::fuzzing::input_folder() / "again";
    write_views(views, again);
    kintsugi::fuzzing::require(
        kintsugi::fuzzing::contents(again) == kintsugi::fuzzing::as_text({data, size}),
        "views are the same when they are written again");
    for (const KeptView& view : views.views) {
      (void)unpacked(view, [](std::int32_t) { return std::nullopt; });
    }
  } catch (const std::runtime_error&) {
  }
  return 0;
}
