#pragma once
// Tables as text: CSV for programs, HTML for people.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace kintsugi::segmenter {

/// Rows of equal length; an empty cell means that there is no value.
struct Table {
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> rows;
};

/// A number with so many decimals; "" for none.
std::string decimal(std::optional<double> value, int decimals);
/// "3,878,785".
std::string grouped(std::int64_t value);

/// RFC 4180: cells that hold a comma, a quote or a line break are quoted. Ends with a line break.
std::string to_csv(const Table& table);

/// & < > " ' as entities.
std::string html_escaped(const std::string& text);
/// A <table> whose cells are escaped; empty cells become a dash.
std::string to_html(const Table& table);

}  // namespace kintsugi::segmenter
