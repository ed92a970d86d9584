#include "segmenter/io/points/text_words.hpp"

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <limits>
#include <system_error>

namespace kintsugi::segmenter {
namespace {

// The value of a number beyond the range of double: zero when too small, else infinity.
double out_of_range_value(std::string_view word) {
  const bool is_small =
      word.find("e-") != std::string_view::npos || word.find("E-") != std::string_view::npos;
  const double magnitude = is_small ? 0.0 : std::numeric_limits<double>::infinity();
  return word[0] == '-' ? -magnitude : magnitude;
}

}  // namespace

std::vector<std::string_view> split_words(std::string_view line) {
  std::vector<std::string_view> words;
  constexpr std::string_view kBlanks = " \t";
  for (auto begin = line.find_first_not_of(kBlanks); begin != std::string_view::npos;) {
    const auto end = std::min(line.find_first_of(kBlanks, begin), line.size());
    words.push_back(line.substr(begin, end - begin));
    begin = line.find_first_not_of(kBlanks, end);
  }
  return words;
}

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlanks = " \t\r";
  const auto begin = text.find_first_not_of(kBlanks);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(kBlanks) + 1 - begin);
}

std::string in_quotes(std::string_view text) {
  constexpr std::size_t kMaxQuoted = 40;
  std::string result = "'";
  for (const char c : text.substr(0, kMaxQuoted)) {
    result += c >= ' ' && c <= '~' ? c : '?';
  }
  return result + (text.size() > kMaxQuoted ? "...'" : "'");
}

std::optional<double> parse_number(std::string_view word) {
  if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
  if (word.empty()) return std::nullopt;
  double value = 0.0;
  const char* const end = word.data() + word.size();
  const auto [rest, error] = std::from_chars(word.data(), end, value);
  if (rest != end || error == std::errc::invalid_argument) return std::nullopt;
  return error == std::errc::result_out_of_range ? out_of_range_value(word) : value;
}

}  // namespace kintsugi::segmenter
