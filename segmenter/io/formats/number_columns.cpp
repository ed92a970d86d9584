#include "segmenter/io/formats/number_columns.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstddef>
#include <utility>

namespace kintsugi::segmenter {
namespace {

constexpr double kMax8Bits = 255.0;
constexpr double kMax16Bits = 65535.0;

/// What the values of some columns have in common.
struct Range {
  bool are_whole = true;
  double min = 0.0;
  double max = 0.0;

  bool is_within(double limit) const { return min >= 0.0 && max <= limit; }
};

Range range_of(const NumberMatrix& matrix, std::size_t first_column, std::size_t num_columns) {
  Range range;
  for (std::size_t row = 0; row < matrix.num_rows(); ++row) {
    for (std::size_t i = 0; i < num_columns; ++i) {
      const double value = matrix.values[row * matrix.num_columns + first_column + i];
      range.are_whole = range.are_whole && value == std::floor(value);  // false for NaN
      range.min = std::min(range.min, value);
      range.max = std::max(range.max, value);
    }
  }
  return range;
}

bool are_normals(const NumberMatrix& matrix, std::size_t first_column) {
  constexpr double kTolerance = 0.02;  // of a normal written with two decimals
  bool has_any = false;
  for (std::size_t row = 0; row < matrix.num_rows(); ++row) {
    const double* const v = matrix.values.data() + row * matrix.num_columns + first_column;
    const double length = std::hypot(v[0], v[1], v[2]);
    if (length == 0.0 || std::isnan(length)) continue;
    if (std::abs(length - 1.0) > kTolerance) return false;
    has_any = true;
  }
  return has_any;
}

bool are_colors(const NumberMatrix& matrix, std::size_t first_column) {
  const Range range = range_of(matrix, first_column, 3);
  return range.is_within(1.0) || (range.are_whole && range.is_within(kMax8Bits));
}

/// Fractions stay real, and so does what no colour can be: cloud_of() names it.
ScalarType color_type(const NumberMatrix& matrix, std::size_t first_column, ScalarType real) {
  const Range range = range_of(matrix, first_column, 3);
  const bool is_fraction = range.is_within(1.0) && range.max > 0.0;
  if (!range.are_whole || is_fraction) return real;
  if (range.is_within(kMax8Bits)) return ScalarType::kUint8;
  return range.is_within(kMax16Bits) ? ScalarType::kUint16 : real;
}

bool is_color_at(const std::vector<std::string>& names, std::size_t column) {
  return column + 2 < names.size() && names[column] == "red" && names[column + 1] == "green" &&
         names[column + 2] == "blue";
}

/// Adds _2, _3, ... to a name that is taken: a PLY file cannot have it twice.
std::vector<std::string> made_unique(const std::vector<std::string>& names) {
  std::vector<std::string> unique;
  unique.reserve(names.size());
  for (const std::string& name : names) {
    std::string candidate = name;
    for (int number = 2; std::ranges::find(unique, candidate) != unique.end(); ++number) {
      candidate = name + "_" + std::to_string(number);
    }
    unique.push_back(std::move(candidate));
  }
  return unique;
}

}  // namespace

std::vector<std::string> guess_column_names(const NumberMatrix& matrix) {
  std::vector<std::string> names{"x", "y", "z"};
  const auto add_scalar = [&] { names.push_back("scalar_" + std::to_string(names.size() - 2)); };
  const std::size_t num_single = (matrix.num_columns - 3) % 3;
  if (num_single > 0) names.emplace_back("intensity");
  if (num_single > 1) add_scalar();
  bool has_normals = false;
  bool has_colors = false;
  while (names.size() < matrix.num_columns) {
    if (!has_normals && are_normals(matrix, names.size())) {
      has_normals = true;
      names.insert(names.end(), {"nx", "ny", "nz"});
    } else if (!has_colors && are_colors(matrix, names.size())) {
      has_colors = true;
      names.insert(names.end(), {"red", "green", "blue"});
    } else {
      for (int i = 0; i < 3; ++i) add_scalar();
    }
  }
  return names;
}

std::string usual_column_name(std::string_view name) {
  using Synonym = std::pair<std::string_view, std::string_view>;
  constexpr std::array<Synonym, 17> kSynonyms{{{"r", "red"},
                                               {"g", "green"},
                                               {"b", "blue"},
                                               {"red", "red"},
                                               {"green", "green"},
                                               {"blue", "blue"},
                                               {"x", "x"},
                                               {"y", "y"},
                                               {"z", "z"},
                                               {"i", "intensity"},
                                               {"intensity", "intensity"},
                                               {"nx", "nx"},
                                               {"ny", "ny"},
                                               {"nz", "nz"},
                                               {"normal_x", "nx"},
                                               {"normal_y", "ny"},
                                               {"normal_z", "nz"}}};
  std::string plain;
  for (const char c : name) {
    const bool is_usable = std::isalnum(static_cast<unsigned char>(c)) != 0 ||
                           std::string_view("_-.:()[]").find(c) != std::string_view::npos;
    if (is_usable) plain += c;
    if (c == ' ') plain += '_';
  }
  std::string lower = plain;
  std::ranges::transform(lower, lower.begin(), [](unsigned char c) { return std::tolower(c); });
  for (const auto& [other, usual] : kSynonyms) {
    if (lower == other) return std::string(usual);
  }
  return plain.empty() ? "unnamed" : plain;
}

PointTable table_of_matrix(const NumberMatrix& matrix, const std::vector<std::string>& names,
                           ScalarType type) {
  PointTable table;
  table.place = "the file";
  const std::vector<std::string> unique = made_unique(names);
  for (std::size_t column = 0; column < matrix.num_columns; ++column) {
    if (is_color_at(unique, column)) {
      const ScalarType of_colors = color_type(matrix, column, type);
      for (std::size_t i = 0; i < 3; ++i) table.add_field(unique[column + i], of_colors);
      column += 2;
    } else {
      table.add_field(unique[column], type);
    }
  }
  table.reserve(matrix.num_rows());
  for (std::size_t row = 0; row < matrix.num_rows(); ++row) {
    char* const record = table.append();
    for (std::size_t column = 0; column < matrix.num_columns; ++column) {
      const PointField& field = table.fields()[column];
      write_scalar(matrix.values[row * matrix.num_columns + column], field.type,
                   record + field.offset);
    }
  }
  return table;
}

}  // namespace kintsugi::segmenter
