#pragma once
// Binary PLY files that are written record by record.

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "lcmtypes/base/atomic_file.hpp"

namespace kintsugi {

/// An element of a PLY file: a list of records with the same properties.
struct PlyElement {
  std::string name;                        ///< "vertex", "face"
  std::vector<std::string> properties;     ///< "float x", "list uchar int vertex_indices"
  std::optional<std::int64_t> count = {};  ///< of records; absent: not known before commit()
};

/// Writes a binary little-endian PLY file. Nothing appears under the final name before commit(),
/// and without commit() nothing remains on disk.
///
/// The header, which contains the counts, comes first in the file. If the counts of all elements
/// are known, header and records go straight into the file. Otherwise the records of each element
/// wait in a temporary file beside it, and commit() copies them; no records are kept in memory.
///
/// Every function throws std::system_error naming the file and the reason when it cannot write.
class PlyWriter {
 public:
  /// @param comments lines for the header
  /// @throws std::invalid_argument when `path` has no file name, or a comment has several lines
  PlyWriter(const std::filesystem::path& path, std::vector<PlyElement> elements,
            const std::vector<std::string>& comments = {});
  ~PlyWriter();

  /// Appends one record to element number `element`; `values` have the types of its properties, in
  /// their order, and arrays stand for several of them. If the counts are known, all records of one
  /// element come before those of the next.
  template <typename... Values>
  void append(std::size_t element, const Values&... values) {
    static_assert((std::is_trivially_copyable_v<Values> && ...));
    std::array<char, (sizeof(Values) + ...)> record;
    std::size_t size = 0;
    ((std::memcpy(record.data() + size, &values, sizeof values), size += sizeof values), ...);
    append_records(element, {record.data(), size}, 1);
  }

  /// Appends `count` records that are in memory as the file has them. Records of lists may differ
  /// in size if the counts of all elements are known.
  void append_records(std::size_t element, std::span<const char> records, std::int64_t count);

  /// Records of element number `element` that were appended.
  std::int64_t count(std::size_t element) const { return lists_.at(element).count; }

  /// Changes a record that was appended: number `record` of element number `element`, its bytes.
  /// Returns whether it stays in the file.
  using Rewrite =
      std::function<bool(std::size_t element, std::int64_t record, std::span<char> bytes)>;

  /// Completes the file; nothing can be appended afterwards. `rewrite`, if there is one, is called
  /// with every record, in order; not where the counts of all elements are known. Returns the
  /// numbers of records in the file, by element.
  /// @throws std::logic_error when an element has not as many records as its count says
  std::vector<std::int64_t> commit(const Rewrite& rewrite = {});

  const std::filesystem::path& path() const { return path_; }

  /// Before commit(): writes another file of the same records, as commit() would.
  /// @throws std::logic_error where the counts of all elements are known
  std::vector<std::int64_t> write_copy(const std::filesystem::path& path, const Rewrite& rewrite);

 private:
  struct List {
    PlyElement element;
    std::int64_t count = 0;
    std::size_t record_bytes = 0;           ///< the same for all
    std::unique_ptr<AtomicFile> temporary;  ///< never committed; null: counts are known
  };

  bool counts_are_known() const;
  std::vector<std::int64_t> write_all(AtomicFile& file, const std::filesystem::path& path,
                                      const Rewrite& rewrite);
  std::int64_t write_kept(std::size_t element, const Rewrite& rewrite, AtomicFile& kept);
  void write_header(AtomicFile& file, const std::vector<std::int64_t>& counts) const;

  std::filesystem::path path_;
  AtomicFile file_;
  std::vector<std::string> comments_;
  std::vector<List> lists_;
};

}  // namespace kintsugi
