#pragma once
// The text files of a recording: lines of words, `#` comments.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace kintsugi::mapper {

struct TextLine {
  int number = 0;                  ///< in the file, from 1
  std::vector<std::string> words;  ///< at least one
};

/// The lines that are not empty, without comments.
/// @throws std::runtime_error naming the file when it cannot be read
std::vector<TextLine> read_text_lines(const std::filesystem::path& file);

/// "FILE:LINE: ", the beginning of an error message.
std::string place(const std::filesystem::path& file, int line);

/// The whole word as a finite decimal number, independent of the locale; else nullopt.
std::optional<double> parse_number(std::string_view word);

/// Decimal seconds as whole microseconds, converted digit by digit, because a double cannot hold
/// the microseconds of every present-day Unix time. Further digits are rounded. nullopt unless the
/// word is digits with at most one point, up to 10^12 seconds.
std::optional<std::int64_t> parse_seconds(std::string_view word);

}  // namespace kintsugi::mapper
