#pragma once
// The objects that are known, in a folder with a folder for each.

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "segmenter/objects/library/known_object.hpp"

namespace kintsugi::segmenter {

/// An object of a library that is not used.
struct RefusedObject {
  std::string name;    ///< of its folder
  std::string reason;  ///< with file and place
};

class ObjectLibrary {
 public:
  /// Reads all objects of a library, in any number of programs, also while objects are taught. What
  /// is no whole object is refused, and the others are used. Names that begin with '.' do not
  /// count. A folder that does not exist is a library without objects.
  /// @param earlier what was read of the folder before: objects whose files have not changed since
  ///   are taken over
  /// @throws std::runtime_error naming the folder when it cannot be read, or is none
  static ObjectLibrary read(const std::filesystem::path& folder, const ObjectLibrary& earlier);
  static ObjectLibrary read(const std::filesystem::path& folder) { return read(folder, {}); }

  /// By name.
  [[nodiscard]] const std::vector<KnownObject>& objects() const { return objects_; }
  /// nullptr when there is no such object, or it was refused.
  [[nodiscard]] const KnownObject* find(std::string_view name) const;
  /// By name.
  [[nodiscard]] const std::vector<RefusedObject>& refusals() const { return refusals_; }
  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }

  /// Whether the folder is not what it was when it was read: an object has come, gone or changed.
  /// Looks at two files an object, without opening them. @throws as read()
  [[nodiscard]] bool has_changed() const;

  /// What is seen of a file without opening it.
  struct FileStamp {
    std::uint64_t inode = 0;
    std::int64_t changed_ns = 0;   ///< since 1970
    std::int64_t modified_ns = 0;  ///< since 1970
    std::int64_t bytes = -1;       ///< -1: it is absent

    bool operator==(const FileStamp&) const = default;
  };
  /// What is seen so of an entry of the folder.
  struct EntryStamp {
    std::string name;
    FileStamp folder;
    FileStamp json;
    FileStamp model;

    bool operator==(const EntryStamp&) const = default;
  };

 private:
  void read_entry(const EntryStamp& entry, const ObjectLibrary& earlier);
  [[nodiscard]] const KnownObject* as_it_was(const EntryStamp& entry) const;

  std::filesystem::path folder_;
  std::vector<EntryStamp> entries_;  ///< as they were when they were read; by name
  std::vector<KnownObject> objects_;
  std::vector<RefusedObject> refusals_;
};

}  // namespace kintsugi::segmenter
