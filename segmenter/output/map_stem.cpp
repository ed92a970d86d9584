#include "segmenter/output/map_stem.hpp"

#include <fmt/format.h>
#include <zlib.h>

namespace kintsugi::segmenter {
namespace {

constexpr std::size_t kMaxNameBytes = 100;  // of 255 that a file name may have

bool is_plain(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' ||
         c == '_';
}

std::string as_file_name(const std::string& name) {
  std::string result;
  for (const char c : name) {
    result +=
        is_plain(c) ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
  }
  if (result.size() > kMaxNameBytes) {
    const auto* const bytes = reinterpret_cast<const Bytef*>(name.data());
    result.resize(kMaxNameBytes);
    result += fmt::format("%{:08X}", crc32_z(0, bytes, name.size()));
  }
  return result;
}

}  // namespace

std::string map_stem(const std::string& map_name, const std::string& plain_name) {
  return map_name == plain_name ? "segments" : "segments_" + as_file_name(map_name);
}

std::string session_stem(const std::string& map_stem, std::int64_t map_session) {
  return map_stem + "_" + std::to_string(map_session);
}

}  // namespace kintsugi::segmenter
