#include "segmenter/io/formats/pcd_header.hpp"

#include <algorithm>
#include <charconv>
#include <limits>
#include <map>
#include <optional>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "segmenter/io/formats/number_columns.hpp"
#include "segmenter/io/points/text_words.hpp"

namespace kintsugi::segmenter {
namespace {

using Words = std::vector<std::string_view>;

struct Line {
  Words words;  // behind the keyword
  std::int64_t number = 0;
};

/// The type of a column for a number of that kind and size; nothing for one that there is not.
std::optional<ScalarType> column_type(char kind, std::size_t size) {
  if (kind == 'F') {
    if (size == 4) return ScalarType::kFloat32;
    return size == 8 ? std::optional(ScalarType::kFloat64) : std::nullopt;
  }
  if (kind != 'I' && kind != 'U') return std::nullopt;
  const bool is_signed = kind == 'I';
  switch (size) {
    case 1:
      return is_signed ? ScalarType::kInt8 : ScalarType::kUint8;
    case 2:
      return is_signed ? ScalarType::kInt16 : ScalarType::kUint16;
    case 4:
      return is_signed ? ScalarType::kInt32 : ScalarType::kUint32;
    case 8:
      return ScalarType::kFloat64;  // PLY has no integers of 64 bits
    default:
      return std::nullopt;
  }
}

class HeaderParser {
 public:
  HeaderParser(std::string_view bytes, const std::string& name) : bytes_(bytes), name_(name) {}

  PcdHeader parse() {
    read_lines();
    header_.num_bytes = position_;
    header_.num_lines = line_number_;
    read_data_kind();
    read_points();
    read_fields();
    keep_viewpoint();
    return std::move(header_);
  }

 private:
  [[noreturn]] void fail(std::int64_t line, const std::string& what) const {
    throw std::runtime_error(name_ + ": line " + std::to_string(line) + ": " + what);
  }

  /// All lines up to that with DATA.
  void read_lines() {
    while (!lines_.contains("DATA")) {
      const std::size_t end = bytes_.find('\n', position_);
      ++line_number_;
      if (end == std::string_view::npos) {
        fail(line_number_, "the file ends inside the PCD header, expected 'DATA ...'");
      }
      const std::string_view line = trimmed(bytes_.substr(position_, end - position_));
      position_ = end + 1;
      if (line.empty() || line[0] == '#') continue;
      Words words = split_words(line);
      const std::string_view keyword = words[0];
      words.erase(words.begin());
      if (!lines_.emplace(keyword, Line{std::move(words), line_number_}).second) {
        fail(line_number_, in_quotes(keyword) + " a second time");
      }
    }
  }

  const Line& line(std::string_view keyword) const {
    const auto found = lines_.find(keyword);
    if (found == lines_.end()) {
      fail(line_number_, "the PCD header has no '" + std::string(keyword) + "'");
    }
    return found->second;
  }

  std::size_t number(const Line& line, std::size_t word, std::size_t max) const {
    const std::string_view text = word < line.words.size() ? line.words[word] : std::string_view();
    std::size_t value = 0;
    const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || rest != text.data() + text.size() || value > max) {
      fail(line.number, in_quotes(text) + ", expected a number from 0 to " + std::to_string(max));
    }
    return value;
  }

  void read_data_kind() {
    const Line& data = line("DATA");
    const std::string_view kind = data.words.empty() ? std::string_view() : data.words[0];
    if (kind == "ascii") {
      header_.data = PcdData::kAscii;
    } else if (kind == "binary") {
      header_.data = PcdData::kBinary;
    } else if (kind == "binary_compressed") {
      header_.data = PcdData::kBinaryCompressed;
    } else {
      fail(data.number,
           "DATA is " + in_quotes(kind) + ", expected ascii, binary or binary_compressed");
    }
  }

  /// POINTS, which old files lack: then WIDTH times HEIGHT.
  void read_points() {
    constexpr std::size_t kMax = std::numeric_limits<std::uint32_t>::max();
    if (lines_.contains("POINTS")) {
      header_.num_points = number(line("POINTS"), 0, kMax);
    } else {
      header_.num_points = number(line("WIDTH"), 0, kMax) * number(line("HEIGHT"), 0, kMax);
    }
  }

  void read_fields() {
    const Line& names = line("FIELDS");
    const Line& sizes = line("SIZE");
    const Line& types = line("TYPE");
    for (const Line* other : {&sizes, &types}) {
      if (other->words.size() != names.words.size()) {
        fail(other->number, std::to_string(other->words.size()) + " entries, expected " +
                                std::to_string(names.words.size()) + ", one for each of FIELDS");
      }
    }
    header_.table.place = "line " + std::to_string(names.number) + ": the list of FIELDS";
    for (std::size_t i = 0; i < names.words.size(); ++i) add_field(i);
  }

  void keep_viewpoint() {
    if (!lines_.contains("VIEWPOINT")) return;
    std::string comment = "VIEWPOINT";
    for (const std::string_view word : line("VIEWPOINT").words) {
      comment.append(" ").append(word);
    }
    header_.table.comments.push_back(std::move(comment));
  }

  std::size_t count_of(std::size_t field) const {
    constexpr std::size_t kMaxCount = 4096;  // a VFH descriptor has 308
    return lines_.contains("COUNT") ? number(line("COUNT"), field, kMaxCount) : 1;
  }

  void add_field(std::size_t i) {
    constexpr std::size_t kMaxValues = 10'000;
    const std::string_view name = line("FIELDS").words[i];
    PcdValue value;
    value.size = number(line("SIZE"), i, 8);
    value.kind = line("TYPE").words[i][0];
    const std::optional<ScalarType> type = column_type(value.kind, value.size);
    if (!type || line("TYPE").words[i].size() != 1) {
      fail(line("TYPE").number,
           "field " + in_quotes(name) + " has type " + in_quotes(line("TYPE").words[i]) + " of " +
               std::to_string(value.size) + " bytes, expected F of 4 or 8, I or U of 1, 2, 4 or 8");
    }
    const std::size_t count = count_of(i);
    if (header_.values.size() + count > kMaxValues) {
      fail(line("FIELDS").number,
           "a point has more than " + std::to_string(kMaxValues) + " numbers");
    }
    header_.point_bytes += count * value.size;
    header_.field_bytes.push_back(count * value.size);
    const std::size_t num_values_before = header_.values.size();
    if (name == "_") {
      value.use = PcdUse::kPadding;
      value.num_repetitions = count;
      header_.values.push_back(value);
    } else if ((name == "rgb" || name == "rgba") && count == 1 && value.size == 4) {
      add_packed_color(value, name == "rgba");
    } else {
      for (std::size_t k = 0; k < count; ++k) {
        header_.values.push_back(value);
        add_column(column_name(name, k, count), *type);
      }
    }
    header_.field_values.push_back(header_.values.size() - num_values_before);
  }

  static std::string column_name(std::string_view name, std::size_t k, std::size_t count) {
    const std::string usual = usual_column_name(name);
    return count == 1 ? usual : usual + "_" + std::to_string(k);
  }

  void add_packed_color(PcdValue value, bool has_alpha) {
    value.use = has_alpha ? PcdUse::kPackedColorAlpha : PcdUse::kPackedColor;
    header_.values.push_back(value);
    for (const char* channel : {"red", "green", "blue"}) add_column(channel, ScalarType::kUint8);
    if (has_alpha) add_column("alpha", ScalarType::kUint8);
  }

  void add_column(const std::string& name, ScalarType type) {
    if (header_.table.find(name)) {
      fail(line("FIELDS").number, "column " + in_quotes(name) + " a second time");
    }
    header_.table.add_field(name, type);
  }

  std::string_view bytes_;
  const std::string& name_;
  std::size_t position_ = 0;
  std::int64_t line_number_ = 0;
  std::map<std::string_view, Line> lines_;
  PcdHeader header_;
};

}  // namespace

PcdHeader parse_pcd_header(std::string_view bytes, const std::string& name) {
  return HeaderParser(bytes, name).parse();
}

}  // namespace kintsugi::segmenter
