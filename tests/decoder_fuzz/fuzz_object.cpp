// An object of a library: object.json, a zero byte, model.ply. The checksum in object.json is made
// right before both are read. What is accepted is the same when it is written and read again.

#include <algorithm>
#include <array>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <string_view>

#include <zlib.h>

#include "segmenter/objects/library/object_files.hpp"
#include "segmenter/objects/library/object_json.hpp"
#include "tests/decoder_fuzz/input_file.hpp"
#include "tests/decoder_fuzz/require.hpp"

namespace {

std::uint32_t crc32_of(std::string_view bytes) {
  return static_cast<std::uint32_t>(
      crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

void set_checksum(std::string& json, std::uint32_t crc32) {
  constexpr std::string_view kKey = "\"model_crc32\": \"";
  const std::size_t at = json.find(kKey);
  if (at == std::string::npos || json.size() < at + kKey.size() + 8) return;
  std::array<char, 9> hex{};
  std::snprintf(hex.data(), hex.size(), "%08x", crc32);
  json.replace(at + kKey.size(), 8, hex.data());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace kintsugi::segmenter;  // NOLINT(google-build-using-namespace)
  const std::string_view input = kintsugi::fuzzing::as_text({data, size});
  const std::size_t end = std::min(input.find('\0'), size);
  std::string json(input.substr(0, end));
  const std::string_view model = input.substr(std::min(end + 1, size));
  set_checksum(json, crc32_of(model));
  try {
    const KnownObject object = parse_object(json, model, "library/mug");
    const std::string again = object_json(object, crc32_of(model));
    const KnownObject same = parse_object(again, model, "library/mug");
    kintsugi::fuzzing::require(same.model.views_O == object.model.views_O, "views stay");
    kintsugi::fuzzing::require(same.lessons == object.lessons, "lessons stay");
    kintsugi::fuzzing::require(again == object_json(same, crc32_of(model)), "the text stays");
  } catch (const std::runtime_error&) {
  }
  return 0;
}
