#include "segmenter/objects/library/object_files.hpp"

#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <stdexcept>
#include <system_error>
#include <vector>

#include <fcntl.h>
#include <zlib.h>

#include "lcmtypes/base/atomic_file.hpp"
#include "lcmtypes/base/file_sync.hpp"
#include "lcmtypes/base/ply_writer.hpp"
#include "segmenter/io/ply/ply_reader.hpp"
#include "segmenter/io/points/file_bytes.hpp"
#include "segmenter/objects/library/object_check.hpp"
#include "segmenter/objects/library/object_json.hpp"
#include "segmenter/objects/library/object_name.hpp"

namespace kintsugi::segmenter {
namespace {

namespace fs = std::filesystem;

/// kMaxObjectViews of about 40 bytes, and as much again for lessons.
constexpr std::uintmax_t kMaxJsonBytes = std::uintmax_t{2} << 20U;
constexpr std::uintmax_t kPointBytes = 31;
constexpr std::uintmax_t kMaxHeaderBytes = 4096;

// Around the name of an object that is being replaced.
constexpr const char* kOlderBegin = ".";
constexpr const char* kOlderEnd = ".old";

std::string read_bounded(const fs::path& path, std::uintmax_t max_bytes) {
  std::error_code error;
  const std::uintmax_t size = fs::file_size(path, error);
  if (!error && size > max_bytes) {
    throw std::runtime_error(path.string() + ": has " + std::to_string(size) + " bytes, at most " +
                             std::to_string(max_bytes) + " were expected");
  }
  return read_file_bytes(path);
}

std::uint32_t crc32_of(std::string_view bytes) {
  return static_cast<std::uint32_t>(
      crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

/// Calls `make`, whose errors get the name of the file.
template <typename Make>
auto naming(const fs::path& file, const Make& make) {
  try {
    return make();
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(file.string() + ": " + error.what());
  }
}

void write_model(const std::vector<CloudPoint>& points_O, const fs::path& path) {
  PlyWriter writer(
      path,
      {{.name = "vertex",
        .properties = {"float x", "float y", "float z", "float nx", "float ny", "float nz",
                       "uchar red", "uchar green", "uchar blue", "float weight"},
        .count = std::ssize(points_O)}},
      {"kintsugi object, frame O, metres"});
  for (const CloudPoint& p : points_O) {
    writer.append(0, p.x, p.y, p.z, p.nx, p.ny, p.nz, p.red, p.green, p.blue, p.weight);
  }
  writer.commit();
}

void write_text(const std::string& text, const fs::path& path) {
  AtomicFile file(path);
  file.stream() << text;
  file.commit();
}

[[noreturn]] void fail(const std::string& what, const fs::path& path, int error) {
  throw std::system_error(error, std::generic_category(),
                          "cannot " + what + " '" + path.string() + "'");
}

void rename_folder(const fs::path& from, const fs::path& to) {
  if (std::rename(from.c_str(), to.c_str()) != 0) fail("rename to", to, errno);
}

/// Puts the folder `beside` into the place of `path`; what was there is in `beside` afterwards.
void exchange(const fs::path& beside, const fs::path& path) {
  if (renameat2(AT_FDCWD, beside.c_str(), AT_FDCWD, path.c_str(), RENAME_EXCHANGE) == 0) return;
  if (errno == ENOENT) return rename_folder(beside, path);  // there was nothing
  if (errno != EINVAL && errno != ENOSYS) fail("replace", path, errno);
  if (!fs::exists(fs::symlink_status(path))) return rename_folder(beside, path);
  // A file system that cannot exchange two names. When this is interrupted, bring_back_objects()
  // finds the older object.
  const fs::path older =
      path.parent_path() / (std::string(kOlderBegin) + path.filename().string() + kOlderEnd);
  fs::remove_all(older);
  rename_folder(path, older);
  rename_folder(beside, path);
  rename_folder(older, beside);
}

/// A folder beside the object's that is removed with all that is in it.
class FolderBeside {
 public:
  FolderBeside(const fs::path& library, const std::string& name)
      : path_(library / ("." + name + ".tmp")) {
    remove();  // what an interrupted program left
    make_folder(path_);
  }
  ~FolderBeside() { remove(); }
  FolderBeside(const FolderBeside&) = delete;
  FolderBeside& operator=(const FolderBeside&) = delete;

  const fs::path& path() const { return path_; }

 private:
  void remove() const {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }

  fs::path path_;
};

fs::path without_slash(const fs::path& folder) {
  return folder.has_filename() ? folder : folder.parent_path();
}

}  // namespace

KnownObject parse_object(std::string_view json, std::string_view model, const fs::path& folder) {
  const fs::path json_path = folder / kObjectFile;
  const fs::path model_path = folder / kModelFile;
  ObjectDocument document = naming(json_path, [&] { return parse_object_json(json); });
  KnownObject& object = document.object;
  const std::string folder_name = without_slash(folder).filename().string();
  if (object.model.name != folder_name) {
    throw std::runtime_error(json_path.string() + ": the name is '" + object.model.name +
                             "', expected that of the folder, '" + folder_name + "'");
  }
  if (crc32_of(model) != document.model_crc32) {
    throw std::runtime_error(model_path.string() + ": its checksum is not that in " + kObjectFile +
                             ": it is damaged, or of another object");
  }
  object.model.points_O = parse_ply(model, model_path.string()).points_W;
  if (object.model.points_O.size() != document.num_points) {
    throw std::runtime_error(model_path.string() + ": has " +
                             std::to_string(object.model.points_O.size()) + " points, expected " +
                             std::to_string(document.num_points) + " as in " + kObjectFile);
  }
  naming(folder, [&] {
    check_object(object);
    return 0;
  });
  return std::move(object);
}

KnownObject read_object(const fs::path& folder) {
  const std::string json = read_bounded(folder / kObjectFile, kMaxJsonBytes);
  const std::string model =
      read_bounded(folder / kModelFile, kMaxHeaderBytes + kMaxObjectPoints * kPointBytes);
  return parse_object(json, model, folder);
}

void write_object(const KnownObject& object, const fs::path& library) {
  check_object(object);
  make_folder(library);
  const FolderBeside beside(library, object.model.name);
  const fs::path model_path = beside.path() / kModelFile;
  write_model(object.model.points_O, model_path);
  write_text(object_json(object, crc32_of(read_file_bytes(model_path))),
             beside.path() / kObjectFile);
  sync_folder(beside.path());
  exchange(beside.path(), library / object.model.name);
  sync_folder(library);
}

void bring_back_objects(const fs::path& library) {
  std::vector<fs::path> olders;
  for (const auto& entry : fs::directory_iterator(library)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with(kOlderBegin) && name.ends_with(kOlderEnd)) olders.push_back(entry.path());
  }
  for (const fs::path& older : olders) {
    const fs::path path = library / older.stem().string().substr(std::string(kOlderBegin).size());
    if (reason_to_refuse_name(path.filename().string())) continue;  // not one of ours
    if (fs::exists(fs::symlink_status(path))) {
      fs::remove_all(older);
    } else {
      rename_folder(older, path);
    }
  }
}

void remove_object(const std::string& name, const fs::path& library) {
  if (const auto reason = reason_to_refuse_name(name)) throw std::runtime_error(*reason);
  const fs::path folder = library / name;
  if (!fs::exists(fs::symlink_status(folder))) {
    throw std::runtime_error(library.string() + ": there is no object '" + name + "'");
  }
  // At once: nobody reads half an object.
  const FolderBeside beside(library, name);
  const fs::path inside = beside.path() / name;
  rename_folder(folder, inside);
  sync_folder(library);
}

}  // namespace kintsugi::segmenter
