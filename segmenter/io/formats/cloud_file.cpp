#include "segmenter/io/formats/cloud_file.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <optional>
#include <stdexcept>
#include <utility>

#include "segmenter/io/formats/las_cloud.hpp"
#include "segmenter/io/formats/npy_cloud.hpp"
#include "segmenter/io/formats/pcd_cloud.hpp"
#include "segmenter/io/formats/text_cloud.hpp"
#include "segmenter/io/ply/ply_table.hpp"
#include "segmenter/io/points/file_bytes.hpp"
#include "segmenter/io/points/text_words.hpp"

namespace kintsugi::segmenter {
namespace {

struct Beginning {
  std::string_view bytes;
  CloudFormat format;
};

constexpr std::array<Beginning, 8> kBeginnings{{{"ply\n", CloudFormat::kPly},
                                                {"ply\r\n", CloudFormat::kPly},
                                                {"LASF", CloudFormat::kLas},
                                                {"\x93NUMPY", CloudFormat::kNpy},
                                                {"# .PCD", CloudFormat::kPcd},
                                                {"VERSION .", CloudFormat::kPcd},
                                                {"VERSION 0.", CloudFormat::kPcd},
                                                {"FIELDS x", CloudFormat::kPcd}}};

/// Files that are told apart from damaged ones, but not read.
constexpr std::array<std::pair<std::string_view, std::string_view>, 6> kOthers{
    {{"ASTM-E57", "an E57 file"},
     {"PK\x03\x04", "a ZIP archive (or NPZ)"},
     {"\x1F\x8B", "a file packed by gzip"},
     {"glTF", "a glTF file"},
     {"OFF", "an OFF file"},
     {"solid ", "an STL file"}}};

constexpr std::array<std::pair<std::string_view, CloudFormat>, 12> kExtensions{
    {{".ply", CloudFormat::kPly},
     {".pcd", CloudFormat::kPcd},
     {".las", CloudFormat::kLas},
     {".laz", CloudFormat::kLas},
     {".npy", CloudFormat::kNpy},
     {".xyz", CloudFormat::kText},
     {".xyzrgb", CloudFormat::kText},
     {".xyzn", CloudFormat::kText},
     {".pts", CloudFormat::kText},
     {".txt", CloudFormat::kText},
     {".csv", CloudFormat::kText},
     {".asc", CloudFormat::kText}}};

std::optional<CloudFormat> format_of_extension(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::ranges::transform(extension, extension.begin(),
                         [](unsigned char c) { return std::tolower(c); });
  for (const auto& [known, format] : kExtensions) {
    if (extension == known) return format;
  }
  return std::nullopt;
}

bool is_text(std::string_view bytes) {
  constexpr std::size_t kLooksAt = 4096;
  return std::ranges::none_of(bytes.substr(0, kLooksAt), [](unsigned char c) {
    return c < ' ' && c != '\n' && c != '\r' && c != '\t';
  });
}

PointTable parse(CloudFormat format, std::string_view bytes, const std::string& name,
                 LabelUse labels) {
  switch (format) {
    case CloudFormat::kPly:
      return parse_ply_table(bytes, name, labels, OtherElements::kKeep);
    case CloudFormat::kPcd:
      return parse_pcd_cloud(bytes, name);
    case CloudFormat::kLas:
      return parse_las_cloud(bytes, name);
    case CloudFormat::kNpy:
      return parse_npy_cloud(bytes, name);
    case CloudFormat::kText:
      break;
  }
  return parse_text_cloud(bytes, name);
}

}  // namespace

std::string_view name_of(CloudFormat format) {
  switch (format) {
    case CloudFormat::kPly:
      return "PLY";
    case CloudFormat::kPcd:
      return "PCD";
    case CloudFormat::kLas:
      return "LAS";
    case CloudFormat::kNpy:
      return "NPY";
    case CloudFormat::kText:
      break;
  }
  return "text";
}

CloudFormat format_of(std::string_view bytes, const std::filesystem::path& path) {
  for (const Beginning& beginning : kBeginnings) {
    if (bytes.starts_with(beginning.bytes)) return beginning.format;
  }
  if (const auto format = format_of_extension(path)) return *format;
  const std::string expected =
      ", expected a cloud as PLY, PCD, LAS, NPY or text (x y z of a point on each line)";
  for (const auto& [beginning, what] : kOthers) {
    if (bytes.starts_with(beginning)) {
      throw std::runtime_error(path.string() + ": is " + std::string(what) + expected);
    }
  }
  if (is_text(bytes)) return CloudFormat::kText;
  throw std::runtime_error(path.string() + ": of an unknown format: begins with " +
                           in_quotes(bytes.substr(0, 8)) + expected);
}

bool has_cloud_extension(const std::filesystem::path& path) {
  return format_of_extension(path).has_value();
}

CloudFile read_cloud_file(const std::filesystem::path& path, LabelUse labels) {
  const std::string bytes = read_file_bytes(path);
  const CloudFormat format = format_of(bytes, path);
  CloudFile file{parse(format, bytes, path.string(), labels), format};
  find_roles(file.table, path.string(), labels);
  return file;
}

}  // namespace kintsugi::segmenter
