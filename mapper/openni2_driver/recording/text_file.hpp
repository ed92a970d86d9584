#pragma once
// The small text files of a recording: lines of words, `#` comments.

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

/// The lines that say something, without comments.
/// @throws std::runtime_error naming the file when it cannot be read.
std::vector<TextLine> read_text_lines(const std::filesystem::path& file);

/// "FILE:LINE: ", the beginning of an error message.
std::string place(const std::filesystem::path& file, int line);

/// A finite decimal number that fills the whole word; the decimal point is a point in any locale.
std::optional<double> parse_number(std::string_view word);

/// Decimal seconds as whole microseconds, by the digits and not through a double (which has no room
/// for the microseconds of a present-day Unix time in every case). Further digits are rounded.
/// nullopt when the word is not digits with at most one point, or is beyond 10^12 seconds.
std::optional<std::int64_t> parse_seconds(std::string_view word);

}  // namespace kintsugi::mapper
