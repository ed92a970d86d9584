#include "segmenter/io/formats/npy_cloud.hpp"

#include <bit>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <system_error>
#include <vector>

#include "segmenter/io/formats/number_columns.hpp"
#include "segmenter/io/points/text_words.hpp"

namespace kintsugi::segmenter {
namespace {

constexpr std::size_t kMaxColumns = 256;

struct Array {
  ScalarType type = ScalarType::kFloat64;
  bool swap = false;
  bool is_fortran_order = false;
  std::vector<std::size_t> shape;
  std::string_view data;
};

class HeaderReader {
 public:
  HeaderReader(std::string_view bytes, const std::string& name) : bytes_(bytes), name_(name) {}

  Array read() {
    take_dictionary();
    Array array;
    read_type(array);
    array.is_fortran_order = value_of("'fortran_order'").starts_with("True");
    read_shape(array);
    array.data = bytes_.substr(header_bytes_);
    return array;
  }

  [[noreturn]] void fail(const std::string& what) const {
    throw std::runtime_error(name_ + ": NPY header: " + what);
  }

 private:
  /// Magic (6 bytes), version (2), length of the dictionary (2 bytes, from version 2 on 4).
  void take_dictionary() {
    constexpr std::size_t kFixedBytes = 8;
    if (bytes_.size() < kFixedBytes + 4) fail("the file ends inside it");
    const std::size_t length_bytes = bytes_[6] == 1 ? 2 : 4;
    std::size_t length = 0;
    for (std::size_t i = length_bytes; i-- > 0;) {
      length = 256 * length + static_cast<unsigned char>(bytes_[kFixedBytes + i]);
    }
    header_bytes_ = kFixedBytes + length_bytes + length;
    if (header_bytes_ > bytes_.size()) {
      fail("claims " + std::to_string(length) + " bytes, but the file has " +
           std::to_string(bytes_.size()));
    }
    dictionary_ = bytes_.substr(kFixedBytes + length_bytes, length);
  }

  /// What follows "KEY:".
  std::string_view value_of(std::string_view key) const {
    const std::size_t at = dictionary_.find(key);
    if (at == std::string_view::npos) fail("no entry " + std::string(key));
    std::string_view rest = trimmed(dictionary_.substr(at + key.size()));
    if (!rest.starts_with(':')) fail("no value of " + std::string(key));
    return trimmed(rest.substr(1));
  }

  void read_type(Array& array) const {
    const std::string_view text = value_of("'descr'");
    const std::string_view type = text.substr(0, text.find(','));  // '<f4'
    const bool is_word = type.size() == 5 && type.front() == '\'' && type.back() == '\'';
    const std::optional<ScalarType> known = is_word ? known_type(type.substr(2, 2)) : std::nullopt;
    if (!known) {
      fail("its type is " + in_quotes(type) +
           ", expected float32, float64 or integers of at most 32 bits: '<f4', '<f8', '|u1', ...");
    }
    array.type = *known;
    const char order = type[1];
    array.swap = order == (std::endian::native == std::endian::little ? '>' : '<');
  }

  static std::optional<ScalarType> known_type(std::string_view kind) {
    if (kind == "f4") return ScalarType::kFloat32;
    if (kind == "f8") return ScalarType::kFloat64;
    if (kind == "i1") return ScalarType::kInt8;
    if (kind == "u1") return ScalarType::kUint8;
    if (kind == "i2") return ScalarType::kInt16;
    if (kind == "u2") return ScalarType::kUint16;
    if (kind == "i4") return ScalarType::kInt32;
    if (kind == "u4") return ScalarType::kUint32;
    return std::nullopt;
  }

  void read_shape(Array& array) const {
    std::string_view text = value_of("'shape'");
    const std::size_t end = text.find(')');
    if (!text.starts_with('(') || end == std::string_view::npos) fail("its shape is no tuple");
    text = text.substr(1, end - 1);
    while (!trimmed(text).empty()) {
      const std::size_t comma = std::min(text.find(','), text.size());
      const std::string_view word = trimmed(text.substr(0, comma));
      std::size_t extent = 0;
      const auto [rest, error] = std::from_chars(word.data(), word.data() + word.size(), extent);
      if (error != std::errc{} || rest != word.data() + word.size()) {
        fail("its shape has " + in_quotes(word) + ", expected a number");
      }
      array.shape.push_back(extent);
      text.remove_prefix(std::min(comma + 1, text.size()));
    }
  }

  std::string_view bytes_;
  const std::string& name_;
  std::size_t header_bytes_ = 0;
  std::string_view dictionary_;
};

/// The number of rows, after checks that the data are exactly as long as the shape says.
std::size_t checked_rows(const Array& array, const HeaderReader& header) {
  std::string shape;
  for (const std::size_t extent : array.shape) shape += " " + std::to_string(extent);
  const bool has_columns = array.shape.size() >= 2 && array.shape.back() >= 3 &&
                           array.shape.back() <= kMaxColumns &&
                           (array.shape.size() == 2 || !array.is_fortran_order);
  if (!has_columns) {
    header.fail("its shape is (" + shape +
                " ), expected N x 3 or more columns, in C order if there are more dimensions");
  }
  const std::size_t row_bytes = array.shape.back() * size_of(array.type);
  const std::size_t max_rows = array.data.size() / row_bytes;
  std::size_t num_rows = 1;
  for (std::size_t i = 0; i + 1 < array.shape.size(); ++i) {
    const bool fits = array.shape[i] == 0 || num_rows <= max_rows / array.shape[i];
    num_rows = fits ? num_rows * array.shape[i] : max_rows + 1;
    if (num_rows == 0) break;
  }
  if (num_rows > max_rows || num_rows * row_bytes != array.data.size()) {
    header.fail("its shape (" + shape + " ) takes " + std::to_string(row_bytes) +
                " bytes a row, and " + std::to_string(array.data.size()) + " bytes follow");
  }
  return num_rows;
}

}  // namespace

PointTable parse_npy_cloud(std::string_view bytes, const std::string& name) {
  HeaderReader header(bytes, name);
  const Array array = header.read();
  const std::size_t num_rows = checked_rows(array, header);
  NumberMatrix matrix;
  matrix.num_columns = array.shape.back();
  matrix.values.reserve(num_rows * matrix.num_columns);
  const std::size_t row_step = array.is_fortran_order ? 1 : matrix.num_columns;
  const std::size_t column_step = array.is_fortran_order ? num_rows : 1;
  for (std::size_t row = 0; row < num_rows; ++row) {
    for (std::size_t column = 0; column < matrix.num_columns; ++column) {
      const std::size_t index = row * row_step + column * column_step;
      matrix.values.push_back(
          read_scalar(array.data.data() + index * size_of(array.type), array.type, array.swap));
    }
  }
  const ScalarType real =
      array.type == ScalarType::kFloat32 ? ScalarType::kFloat32 : ScalarType::kFloat64;
  return table_of_matrix(matrix, guess_column_names(matrix), real);
}

}  // namespace kintsugi::segmenter
