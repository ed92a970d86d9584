#pragma once
// Tables of files that are matrices of numbers, with or without names of columns.

#include <string>
#include <string_view>
#include <vector>

#include "segmenter/io/points/point_table.hpp"

namespace kintsugi::segmenter {

/// A matrix, row after row.
struct NumberMatrix {
  std::vector<double> values;
  std::size_t num_columns = 0;

  std::size_t num_rows() const { return num_columns == 0 ? 0 : values.size() / num_columns; }
};

/// Names for columns that have none: x y z, then a single column or two (the first is intensity,
/// the second scalar_2) unless the rest are threes, then threes: nx ny nz where all rows have
/// length 1 (or 0, or NaN), red green blue where all are whole numbers from 0 to 255 or lie in
/// 0..1, else scalar_N.
///
/// @param matrix of at least 3 columns
std::vector<std::string> guess_column_names(const NumberMatrix& matrix);

/// The name that a column has in a table: those of positions, normals, colours and intensity as
/// find_roles() knows them, whatever their case ("R" -> "red", "//X" -> "x"), others as they are
/// but without blanks and quotes.
std::string usual_column_name(std::string_view name);

/// A table of all columns. Colours become uchar or ushort, if whole numbers; the others have
/// `type`. A name that occurs a second time gets a number.
PointTable table_of_matrix(const NumberMatrix& matrix, const std::vector<std::string>& names,
                           ScalarType type);

}  // namespace kintsugi::segmenter
