#pragma once
// The points of a file as a table: everything that the file says about each, in the file's types.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "segmenter/io/points/scalar_type.hpp"

namespace kintsugi::segmenter {

/// A column of the table.
struct PointField {
  std::string name;  ///< as PLY calls it: "x", "nx", "red", "intensity"
  ScalarType type = ScalarType::kFloat32;
  std::size_t offset = 0;  ///< bytes from the beginning of a record
  bool is_list = false;    ///< a list of a PLY file, of which only the length is kept
};

/// What a PLY file has besides its vertices, such as faces: little-endian records as they are in a
/// file.
struct OtherElement {
  std::string name;
  std::vector<std::string> properties;  ///< "list uchar int vertex_indices"
  std::int64_t count = 0;
  std::string records;
};

/// One packed record of bytes for each point, in this machine's byte order.
class PointTable {
 public:
  /// Adds a column; before the first record.
  void add_field(std::string name, ScalarType type, bool is_list = false);

  const std::vector<PointField>& fields() const { return fields_; }
  std::optional<std::size_t> find(std::string_view name) const;
  std::size_t record_bytes() const { return record_bytes_; }

  std::size_t size() const { return num_points_; }
  void reserve(std::size_t num_points) { records_.reserve(num_points * record_bytes_); }
  /// Adds a point whose values are 0, and returns its record, valid until the next is added.
  char* append();

  std::span<const char> record(std::size_t point) const {
    return {records_.data() + point * record_bytes_, record_bytes_};
  }
  double value(std::size_t point, std::size_t field) const {
    return read_scalar(record(point).data() + fields_[field].offset, fields_[field].type);
  }
  void set_value(std::size_t point, std::size_t field, double value) {
    write_scalar(value, fields_[field].type,
                 records_.data() + point * record_bytes_ + fields_[field].offset);
  }

  std::string
      place;  ///< where the file declares the columns, for errors: "line 3: element 'vertex'"
  std::vector<std::string> comments;           ///< of the file's header, in its order
  std::vector<OtherElement> other_elements{};  ///< of a PLY file, if they were asked for

 private:
  std::vector<PointField> fields_;
  std::size_t record_bytes_ = 0;
  std::size_t num_points_ = 0;
  std::vector<char> records_;
};

}  // namespace kintsugi::segmenter
