#include "segmenter/io/formats/text_cloud.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "segmenter/io/formats/number_columns.hpp"
#include "segmenter/io/points/text_words.hpp"

namespace kintsugi::segmenter {
namespace {

using Words = std::vector<std::string_view>;

/// Without the quotes that some programs put around every value.
std::string_view unquoted(std::string_view place) {
  const bool is_quoted = place.size() > 1 && place.front() == '"' && place.back() == '"';
  return is_quoted ? trimmed(place.substr(1, place.size() - 2)) : place;
}

/// Without a comment at its end, behind a blank.
std::string_view without_comment(std::string_view line) {
  for (std::size_t i = 1; i < line.size(); ++i) {
    const bool begins = line[i] == '#' || line.substr(i).starts_with("//");
    if (begins && (line[i - 1] == ' ' || line[i - 1] == '\t')) return trimmed(line.substr(0, i));
  }
  return line;
}

/// The places between commas or semicolons, if there are any, else words between blanks. A
/// separator at the end of the line has an empty place behind it only if there are `expected`
/// places then.
Words split_places(std::string_view line, std::size_t expected) {
  char separator = ' ';
  if (line.find(';') != std::string_view::npos) {
    separator = ';';
  } else if (line.find(',') != std::string_view::npos) {
    separator = ',';
  }
  if (separator == ' ') {
    Words words = split_words(line);
    std::ranges::transform(words, words.begin(), unquoted);
    return words;
  }
  Words places;
  for (std::size_t begin = 0; begin <= line.size();) {
    const std::size_t end = std::min(line.find(separator, begin), line.size());
    places.push_back(unquoted(trimmed(line.substr(begin, end - begin))));
    begin = end + 1;
  }
  if (places.back().empty() && places.size() != expected) places.pop_back();
  return places;
}

class TextReader {
 public:
  TextReader(std::string_view bytes, const std::string& name) : bytes_(bytes), name_(name) {}

  PointTable read() {
    constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
    if (bytes_.starts_with(kByteOrderMark)) position_ = kByteOrderMark.size();
    while (position_ < bytes_.size()) read_line(next_line());
    check_count();
    if (matrix_.num_columns == 0) fail("no line of numbers, expected x y z of a point");
    PointTable table = table_of_matrix(
        matrix_, names_.empty() ? guess_column_names(matrix_) : names_, ScalarType::kFloat64);
    if (!names_.empty()) {
      table.place = "line " + std::to_string(names_line_) + ": the list of columns";
    }
    return table;
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw std::runtime_error(name_ + ": line " + std::to_string(line_number_) + ": " + what);
  }

  std::string_view next_line() {
    ++line_number_;
    const std::size_t end = std::min(bytes_.find('\n', position_), bytes_.size());
    const std::string_view line = bytes_.substr(position_, end - position_);
    position_ = end + 1;
    return trimmed(line);
  }

  void read_line(std::string_view line) {
    if (line.empty()) return;
    const bool is_comment = line[0] == '#' || line.starts_with("//");
    if (is_comment) line.remove_prefix(std::min(line.find_first_not_of("#/ \t"), line.size()));
    if (matrix_.num_columns == 0 && (is_comment || names_.empty())) {
      const Words words = split_places(line, 0);
      const bool is_row = !is_comment && !words.empty() && parse_number(words[0]);
      if (!is_row && names_xyz(words)) return take_names(words);
    }
    if (!is_comment) read_numbers(without_comment(line));
  }

  void read_numbers(std::string_view line) {
    const Words places =
        split_places(line, matrix_.num_columns > 0 ? matrix_.num_columns : names_.size());
    if (places.size() == 1) {
      begin_block(places[0]);
    } else if (matrix_.num_columns == 0 && names_.empty() && !places[0].empty() &&
               !parse_number(places[0])) {
      fail("begins with " + in_quotes(places[0]) +
           ", expected numbers, or names of columns with x, y and z");
    } else {
      read_row(places);
    }
  }

  static bool names_xyz(const Words& words) {
    int num_found = 0;
    for (const std::string_view word : words) {
      const std::string usual = usual_column_name(word);
      if (usual == "x" || usual == "y" || usual == "z") ++num_found;
    }
    return num_found == 3;
  }

  void take_names(const Words& words) {
    names_.clear();
    names_.reserve(words.size());
    for (const std::string_view word : words) names_.push_back(usual_column_name(word));
    names_line_ = line_number_;
  }

  /// A line that tells how many points follow.
  void begin_block(std::string_view word) {
    constexpr double kMaxCount = 1e15;
    const std::optional<double> count = parse_number(word);
    const bool is_count =
        count && *count >= 0.0 && *count <= kMaxCount && *count == std::floor(*count);
    if (!is_count) fail(in_quotes(word) + " alone, expected x y z of a point, or their number");
    if (!block_count_ && matrix_.num_rows() > 0) {
      fail("one number, expected " + std::to_string(matrix_.num_columns));
    }
    check_count();
    block_count_ = static_cast<std::size_t>(*count);
    block_line_ = line_number_;
    block_begin_ = matrix_.num_rows();
  }

  void check_count() const {
    const std::size_t num_rows = matrix_.num_rows() - block_begin_;
    if (!block_count_ || num_rows == *block_count_) return;
    throw std::runtime_error(name_ + ": line " + std::to_string(block_line_) + ": tells " +
                             std::to_string(*block_count_) + " points, but " +
                             std::to_string(num_rows) + " lines of numbers follow");
  }

  void read_row(const Words& places) {
    constexpr std::size_t kMaxColumns = 256;
    if (matrix_.num_columns == 0) {
      if (places.size() < 3 || places.size() > kMaxColumns) {
        fail(std::to_string(places.size()) + " numbers, expected x y z and at most " +
             std::to_string(kMaxColumns));
      }
      if (!names_.empty() && names_.size() != places.size()) {
        fail(std::to_string(places.size()) + " numbers, expected " + std::to_string(names_.size()) +
             ", as line " + std::to_string(names_line_) + " names columns");
      }
      matrix_.num_columns = places.size();
    }
    if (places.size() != matrix_.num_columns) {
      fail(std::to_string(places.size()) + " numbers, expected " +
           std::to_string(matrix_.num_columns) + " as in the first row");
    }
    for (const std::string_view place : places) {
      const std::optional<double> value =
          place.empty() ? std::numeric_limits<double>::quiet_NaN() : parse_number(place);
      if (!value) fail(in_quotes(place) + " is not a number");
      matrix_.values.push_back(*value);
    }
  }

  std::string_view bytes_;
  const std::string& name_;
  std::size_t position_ = 0;
  std::int64_t line_number_ = 0;
  std::vector<std::string> names_;  // empty: the file has none
  std::int64_t names_line_ = 0;
  NumberMatrix matrix_;
  std::optional<std::size_t> block_count_;  // as the last line of one number tells
  std::int64_t block_line_ = 0;
  std::size_t block_begin_ = 0;  // the row that follows it
};

}  // namespace

PointTable parse_text_cloud(std::string_view bytes, const std::string& name) {
  return TextReader(bytes, name).read();
}

}  // namespace kintsugi::segmenter
