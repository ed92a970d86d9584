#pragma once
// Words and numbers of text files.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace kintsugi::segmenter {

/// The words of a line between blanks and tabs.
std::vector<std::string_view> split_words(std::string_view line);

/// `text` without blanks, tabs and carriage returns on either side.
std::string_view trimmed(std::string_view text);

/// A quotation for an error message: short, and printable whatever the file contains.
std::string in_quotes(std::string_view text);

/// The number that `word` as a whole stands for, in C's notation, with nan, inf and a sign. Numbers
/// too large for double become infinite, too small ones 0. Nothing for other words.
std::optional<double> parse_number(std::string_view word);

}  // namespace kintsugi::segmenter
