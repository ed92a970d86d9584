#include "mapper/openni2_driver/formats/text_file.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace kintsugi::mapper {
namespace {

constexpr std::size_t kMaxSecondDigits = 12;  // 10^12 s in microseconds still fits 63 bits
constexpr std::size_t kMicrosecondDigits = 6;

bool all_digits(std::string_view text) {
  return std::ranges::all_of(text, [](char c) { return c >= '0' && c <= '9'; });
}

std::int64_t parse_digits(std::string_view digits) {
  std::int64_t value = 0;
  for (const char c : digits) value = value * 10 + (c - '0');
  return value;
}

}  // namespace

std::vector<TextLine> read_text_lines(const std::filesystem::path& file) {
  std::ifstream stream(file);
  if (!stream) throw std::runtime_error(file.string() + ": cannot be read");
  std::vector<TextLine> lines;
  std::string text;
  for (int number = 1; std::getline(stream, text); ++number) {
    std::istringstream words(text.substr(0, text.find('#')));
    TextLine line{.number = number, .words = {}};
    for (std::string word; words >> word;) line.words.push_back(word);
    if (!line.words.empty()) lines.push_back(std::move(line));
  }
  if (stream.bad()) throw std::runtime_error(file.string() + ": reading it failed");
  return lines;
}

std::string place(const std::filesystem::path& file, int line) {
  return file.string() + ":" + std::to_string(line) + ": ";
}

std::optional<double> parse_number(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size()) return std::nullopt;
  if (!std::isfinite(value)) return std::nullopt;
  return value;
}

std::optional<std::int64_t> parse_seconds(std::string_view word) {
  const std::size_t point = word.find('.');
  std::string_view whole = word.substr(0, point);
  const std::string_view fraction =
      point == std::string_view::npos ? std::string_view() : word.substr(point + 1);
  if (whole.empty() || !all_digits(whole) || !all_digits(fraction)) return std::nullopt;
  whole.remove_prefix(std::min(whole.find_first_not_of('0'), whole.size()));
  if (whole.size() > kMaxSecondDigits) return std::nullopt;

  std::string microseconds(fraction.substr(0, kMicrosecondDigits));
  microseconds.resize(kMicrosecondDigits, '0');
  const bool round_up = fraction.size() > kMicrosecondDigits && fraction[kMicrosecondDigits] >= '5';
  return parse_digits(whole) * 1'000'000 + parse_digits(microseconds) + (round_up ? 1 : 0);
}

}  // namespace kintsugi::mapper
