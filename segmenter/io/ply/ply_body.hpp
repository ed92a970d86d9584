#pragma once
// The data of a PLY file, row by row, in any of the three formats.

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "segmenter/io/ply/ply_header.hpp"

namespace kintsugi::segmenter {

/// Reads the rows of a PLY file from the first to the last. Every read is checked against the end
/// of the file. Errors are std::runtime_error and name file, element, row and place (byte offset,
/// or line of an ascii file).
class PlyBody {
 public:
  virtual ~PlyBody() = default;

  /// Call it before allocating memory for the rows that the header claims.
  /// @throws std::runtime_error unless the rest of the file can hold these rows
  void check_count(const PlyElement& element) const;

  /// Reads one row. `values` gets one entry for each property, for a list its length.
  virtual void read_row(const PlyElement& element, std::int64_t row,
                        std::vector<double>& values) = 0;

  /// Passes all rows of an element, and appends them to `records`, if that is not null, as a binary
  /// little-endian file has them.
  void pass(const PlyElement& element, std::string* records);

  /// @throws std::runtime_error when anything but blanks follows the last row
  void expect_end() const;

 protected:
  PlyBody(std::string_view bytes, std::size_t position, std::string path)
      : bytes_(bytes), position_(position), path_(std::move(path)) {}

  std::size_t num_bytes_left() const { return bytes_.size() - position_; }
  [[noreturn]] void fail(const PlyElement& element, std::int64_t row,
                         const std::string& what) const;

  /// The fewest bytes a row of this element can take.
  virtual std::size_t min_row_bytes(const PlyElement& element) const = 0;
  /// "line 12" or "byte 345".
  virtual std::string place() const = 0;

  /// Every value that is read, in the order of the file; goes to where pass() says.
  void keep(double value, ScalarType type);

  std::string_view bytes_;
  std::size_t position_;
  std::string path_;

 private:
  std::string* records_ = nullptr;
};

/// @param bytes the whole file; must outlive the result
std::unique_ptr<PlyBody> make_ply_body(std::string_view bytes, const PlyHeader& header,
                                       const std::string& path);

}  // namespace kintsugi::segmenter
