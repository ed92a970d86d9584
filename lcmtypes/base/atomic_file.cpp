#include "lcmtypes/base/atomic_file.hpp"

#include <array>
#include <cerrno>
#include <stdexcept>
#include <streambuf>
#include <string>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <unistd.h>

#include "lcmtypes/base/file_sync.hpp"

namespace kintsugi {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const char* what, const std::string& file, int error) {
  throw std::system_error(error, std::generic_category(),
                          std::string("cannot ") + what + " " + file);
}

std::string quoted(const fs::path& path) { return std::string("'") + path.string() + "'"; }

/// Both names of the file, for errors: a person knows only the final one.
std::string both_names(const fs::path& path, const fs::path& partial) {
  return quoted(path) + " (by way of " + quoted(partial.filename()) + ")";
}

/// A file descriptor that closes itself.
class Descriptor {
 public:
  /// @param file its name in errors
  Descriptor(const fs::path& path, int flags, const std::string& file)
      : value_(open(path.c_str(), flags | O_CLOEXEC, 0666)) {
    if (value_ < 0) fail("open", file, errno);
  }
  ~Descriptor() {
    if (value_ >= 0) ::close(value_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  int get() const { return value_; }
  int close() { return ::close(std::exchange(value_, -1)); }

 private:
  int value_;
};

/// The file to which links lead, which remain. A device or a pipe would be replaced by a file.
fs::path checked(const fs::path& path) {
  if (!path.has_filename()) {
    throw std::invalid_argument("output file '" + path.string() + "' has no file name");
  }
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status)) {
    throw std::invalid_argument("output file '" + path.string() + "' is no regular file");
  }
  return fs::is_regular_file(status) && fs::is_symlink(path, error) ? fs::canonical(path) : path;
}

fs::path partial_name(const fs::path& path) {
  fs::path partial = path;
  // The extension stays at the end: libraries choose the format by it.
  partial.replace_filename(path.stem().string() + ".partial" + path.extension().string());
  return partial;
}

}  // namespace

/// Buffers writes, and throws with the reason when one fails; std::ofstream does not keep the
/// reason.
class AtomicFile::FileBuffer : public std::streambuf {
 public:
  /// @param name its name in errors
  FileBuffer(const fs::path& path, std::string name)
      : name_(std::move(name)), file_(path, O_WRONLY | O_CREAT | O_TRUNC, name_) {
    setp(buffer_.data(), buffer_.data() + buffer_.size());
  }

 protected:
  int_type overflow(int_type character) override {
    sync();
    if (character != traits_type::eof()) sputc(traits_type::to_char_type(character));
    return traits_type::not_eof(character);
  }

  int sync() override {
    const char* from = pbase();
    while (from != pptr()) {
      const ssize_t written = write(file_.get(), from, static_cast<std::size_t>(pptr() - from));
      if (written < 0 && errno == EINTR) continue;
      if (written < 0) fail("write", name_, errno);
      from += written;
    }
    setp(buffer_.data(), buffer_.data() + buffer_.size());
    return 0;
  }

 private:
  std::string name_;
  Descriptor file_;
  std::array<char, std::size_t{1} << 16U> buffer_;
};

AtomicFile::AtomicFile(const fs::path& path)
    : path_(checked(path)), partial_path_(partial_name(path_)) {}

AtomicFile::~AtomicFile() {
  if (committed_) return;
  stream_.reset();
  buffer_.reset();
  std::error_code ignored;
  fs::remove(partial_path_, ignored);
}

std::ostream& AtomicFile::stream() {
  if (!stream_) {
    buffer_ = std::make_unique<FileBuffer>(partial_path_, both_names(path_, partial_path_));
    stream_ = std::make_unique<std::ostream>(buffer_.get());
    stream_->exceptions(std::ios::badbit | std::ios::failbit);
  }
  return *stream_;
}

void AtomicFile::commit() {
  if (stream_) stream_->flush();
  stream_.reset();
  buffer_.reset();
  const std::string names = both_names(path_, partial_path_);
  {
    Descriptor file(partial_path_, O_WRONLY, names);
    sync_file(file.get(), names);
    if (file.close() != 0) fail("close", names, errno);
  }
  if (std::rename(partial_path_.c_str(), path_.c_str()) != 0) fail("rename", names, errno);
  committed_ = true;
  sync_folder(path_.parent_path());  // without its entry in the folder the file is lost
}

}  // namespace kintsugi
