#include "segmenter/io/ply/ply_header.hpp"

#include <algorithm>
#include <charconv>
#include <stdexcept>
#include <utility>

#include "segmenter/io/points/text_words.hpp"

namespace kintsugi::segmenter {
namespace {

// What follows the first of these words of a line.
std::string_view text_after(const std::vector<std::string_view>& words) {
  if (words.size() < 2) return {};
  return {words[1].data(), words.back().data() + words.back().size()};
}

// Reads the header line by line.
class HeaderParser {
 public:
  HeaderParser(std::string_view bytes, const std::string& path) : bytes_(bytes), path_(path) {}

  PlyHeader parse() {
    if (next_line("'ply'") != "ply") {
      fail("not a PLY file: the first line must be 'ply'");
    }
    parse_format(split_words(next_line("'format'")));
    while (!parse_declaration(next_line("'end_header'"))) {
    }
    header_.num_bytes = position_;
    header_.num_lines = line_number_;
    return std::move(header_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw std::runtime_error(path_ + ": line " + std::to_string(line_number_) + ": " + what);
  }

  std::string_view next_line(const std::string& expected) {
    ++line_number_;
    const auto end = bytes_.find('\n', position_);
    if (end == std::string_view::npos) {
      if (line_number_ == 1) {
        fail("not a PLY file: the first line must be 'ply'");
      }
      fail("the file ends inside the header, expected " + expected);
    }
    std::string_view line = bytes_.substr(position_, end - position_);
    position_ = end + 1;
    if (line.ends_with('\r')) {
      line.remove_suffix(1);
    }
    return line;
  }

  void parse_format(const std::vector<std::string_view>& words) {
    constexpr auto kExpected =
        "expected 'format ascii 1.0', 'format binary_little_endian 1.0' or "
        "'format binary_big_endian 1.0'";
    if (words.size() != 3 || words[0] != "format" || words[2] != "1.0") {
      fail(kExpected);
    }
    if (words[1] == "ascii") {
      header_.format = PlyFormat::kAscii;
    } else if (words[1] == "binary_little_endian") {
      header_.format = PlyFormat::kBinaryLittleEndian;
    } else if (words[1] == "binary_big_endian") {
      header_.format = PlyFormat::kBinaryBigEndian;
    } else {
      fail("unknown format " + in_quotes(words[1]) + ", " + kExpected);
    }
  }

  // Returns true at end_header.
  bool parse_declaration(std::string_view line) {
    const auto words = split_words(line);
    const std::string_view keyword = words.empty() ? std::string_view{} : words[0];
    if (keyword == "end_header") {
      return true;
    }
    if (keyword == "element") {
      parse_element(words);
    } else if (keyword == "property") {
      parse_property(words);
    } else if (keyword == "comment") {
      header_.comments.emplace_back(text_after(words));
    } else if (keyword != "obj_info") {
      fail("unknown keyword " + in_quotes(keyword) +
           ", expected element, property, comment, obj_info or end_header");
    }
    return false;
  }

  void parse_element(const std::vector<std::string_view>& words) {
    if (words.size() != 3) {
      fail("expected 'element NAME COUNT'");
    }
    PlyElement element{std::string(words[1]), 0, line_number_, {}};
    const char* const end = words[2].data() + words[2].size();
    const auto [rest, error] = std::from_chars(words[2].data(), end, element.count);
    if (error != std::errc{} || rest != end || element.count < 0) {
      fail("the count of element " + in_quotes(words[1]) + " is " + in_quotes(words[2]) +
           ", expected a number >= 0");
    }
    for (const PlyElement& other : header_.elements) {
      if (other.name == element.name) {
        fail("element " + in_quotes(words[1]) + " is declared a second time");
      }
    }
    header_.elements.push_back(std::move(element));
  }

  void parse_property(const std::vector<std::string_view>& words) {
    if (header_.elements.empty()) {
      fail("a property before the first element");
    }
    PlyProperty property;
    if (words.size() == 5 && words[1] == "list") {
      property = {std::string(words[4]), parse_type(words[3]), parse_type(words[2])};
      if (!is_integer(*property.list_count)) {
        fail("the length of list " + in_quotes(words[4]) + " must have an integer type");
      }
    } else if (words.size() == 3) {
      property = {std::string(words[2]), parse_type(words[1]), std::nullopt};
    } else {
      fail("expected 'property TYPE NAME' or 'property list TYPE TYPE NAME'");
    }
    PlyElement& element = header_.elements.back();
    if (element.find(property.name)) {
      fail("property " + in_quotes(property.name) + " of element " + in_quotes(element.name) +
           " is declared a second time");
    }
    element.properties.push_back(std::move(property));
  }

  ScalarType parse_type(std::string_view word) const {
    if (const auto type = scalar_type_of(word)) return *type;
    fail("unknown type " + in_quotes(word) +
         ", expected char, uchar, short, ushort, int, uint, float or double");
  }

  std::string_view bytes_;
  const std::string& path_;
  std::size_t position_ = 0;
  int line_number_ = 0;
  PlyHeader header_;
};

}  // namespace

std::optional<std::size_t> PlyElement::find(std::string_view property) const {
  const auto found = std::find_if(properties.begin(), properties.end(),
                                  [&](const PlyProperty& p) { return p.name == property; });
  if (found == properties.end()) {
    return std::nullopt;
  }
  return static_cast<std::size_t>(found - properties.begin());
}

PlyHeader parse_ply_header(std::string_view bytes, const std::string& path) {
  return HeaderParser(bytes, path).parse();
}

}  // namespace kintsugi::segmenter
