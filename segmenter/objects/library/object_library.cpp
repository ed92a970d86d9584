#include "segmenter/objects/library/object_library.hpp"

#include <algorithm>
#include <stdexcept>
#include <system_error>
#include <utility>

#include <sys/stat.h>

#include "segmenter/objects/library/object_files.hpp"
#include "segmenter/objects/library/object_name.hpp"

namespace kintsugi::segmenter {
namespace {

namespace fs = std::filesystem;
using EntryStamp = ObjectLibrary::EntryStamp;
using FileStamp = ObjectLibrary::FileStamp;

std::int64_t nanoseconds(const timespec& time) {
  return std::int64_t{1'000'000'000} * time.tv_sec + time.tv_nsec;
}

FileStamp stamp_of(const fs::path& path) {
  struct stat status {};
  if (stat(path.c_str(), &status) != 0) return {};
  return {.inode = status.st_ino,
          .changed_ns = nanoseconds(status.st_ctim),
          .modified_ns = nanoseconds(status.st_mtim),
          .bytes = S_ISDIR(status.st_mode) ? 0 : std::int64_t{status.st_size}};
}

EntryStamp entry_of(const fs::path& folder, const std::string& name) {
  const fs::path path = folder / name;
  return {.name = name,
          .folder = stamp_of(path),
          .json = stamp_of(path / kObjectFile),
          .model = stamp_of(path / kModelFile)};
}

/// By name.
std::vector<EntryStamp> entries_of(const fs::path& folder) {
  std::vector<EntryStamp> entries;
  std::error_code error;
  if (!fs::exists(folder, error) && !error) return entries;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    if (name.front() != '.') entries.push_back(entry_of(folder, name));
  }
  if (error) {
    throw std::runtime_error(folder.string() +
                             ": cannot be read as a library of objects: " + error.message());
  }
  std::sort(entries.begin(), entries.end(),
            [](const EntryStamp& a, const EntryStamp& b) { return a.name < b.name; });
  return entries;
}

}  // namespace

/// nullptr when it was not used, or has changed.
const KnownObject* ObjectLibrary::as_it_was(const EntryStamp& entry) const {
  const auto known = std::ranges::lower_bound(entries_, entry.name, {}, &EntryStamp::name);
  return known != entries_.end() && *known == entry ? find(entry.name) : nullptr;
}

void ObjectLibrary::read_entry(const EntryStamp& entry, const ObjectLibrary& earlier) {
  if (earlier.folder_ == folder_) {
    if (const KnownObject* const known = earlier.as_it_was(entry)) {
      objects_.push_back(*known);
      return;
    }
  }
  const fs::path path = folder_ / entry.name;
  try {
    if (!fs::is_directory(path)) {
      throw std::runtime_error(path.string() + ": is no folder, as an object is");
    }
    if (const auto reason = reason_to_refuse_name(entry.name)) {
      throw std::runtime_error(path.string() + ": " + *reason);
    }
    objects_.push_back(read_object(path));
  } catch (const std::exception& error) {
    refusals_.push_back({entry.name, error.what()});
  }
}

ObjectLibrary ObjectLibrary::read(const fs::path& folder, const ObjectLibrary& earlier) {
  // An object that is replaced between the reading of its two files would be refused. So what
  // changes meanwhile is read again; somebody who changes it all the time is not waited for.
  constexpr int kAttempts = 3;
  ObjectLibrary library;
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    library = {};
    library.folder_ = folder;
    library.entries_ = entries_of(folder);
    for (const EntryStamp& entry : library.entries_) library.read_entry(entry, earlier);
    if (library.refusals_.empty() || !library.has_changed()) break;
  }
  return library;
}

const KnownObject* ObjectLibrary::find(std::string_view name) const {
  const auto name_of = [](const KnownObject& object) -> const std::string& {
    return object.model.name;
  };
  const auto found = std::ranges::lower_bound(objects_, name, {}, name_of);
  return found == objects_.end() || found->model.name != name ? nullptr : &*found;
}

bool ObjectLibrary::has_changed() const { return entries_of(folder_) != entries_; }

}  // namespace kintsugi::segmenter
