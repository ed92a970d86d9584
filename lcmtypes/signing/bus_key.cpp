#include "lcmtypes/signing/bus_key.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <stdexcept>
#include <string>
#include <system_error>

#include <fcntl.h>
#include <sodium.h>
#include <sys/stat.h>
#include <unistd.h>

#include "lcmtypes/base/file_sync.hpp"

namespace kintsugi {
namespace {

void start_sodium() {
  if (sodium_init() < 0) throw std::runtime_error("libsodium cannot be initialised");
}

[[noreturn]] void fail(const std::filesystem::path& path, const std::string& what) {
  throw std::runtime_error("bus key '" + path.string() + "' " + what);
}

/// A file descriptor that is closed.
class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() {
    if (number_ >= 0) close(number_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int operator*() const { return number_; }

 private:
  int number_;
};

void check_file(const std::filesystem::path& path, int descriptor) {
  struct stat state {};
  if (fstat(descriptor, &state) != 0) {
    fail(path, std::string("cannot be read: ") + std::strerror(errno));
  }
  if (!S_ISREG(state.st_mode)) fail(path, "is no file; kintsugi-keygen makes one");
  if ((state.st_mode & (S_IRWXG | S_IRWXO)) != 0) {
    char mode[8];
    std::snprintf(mode, sizeof mode, "%04o", state.st_mode & 07777U);
    fail(path, std::string("has mode ") + mode +
                   ", so others than its owner may use it; expected 0600: chmod 600 " +
                   path.string());
  }
  if (state.st_size != static_cast<off_t>(BusKey::kBytes)) {
    fail(path, "has " + std::to_string(state.st_size) + " bytes, expected " +
                   std::to_string(BusKey::kBytes) + "; kintsugi-keygen makes one");
  }
}

}  // namespace

BusKey::BusKey(const Secret& secret) : secret_(secret) { start_sodium(); }

BusKey::~BusKey() { sodium_memzero(secret_.data(), secret_.size()); }

std::shared_ptr<const BusKey> BusKey::read(const std::filesystem::path& path) {
  // Without O_NONBLOCK a FIFO would be waited for.
  const Descriptor file(open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  if (*file < 0) fail(path, std::string("cannot be opened: ") + std::strerror(errno));
  check_file(path, *file);
  Secret secret{};
  if (::read(*file, secret.data(), secret.size()) != static_cast<ssize_t>(secret.size())) {
    fail(path, "cannot be read");
  }
  auto key = std::make_shared<const BusKey>(secret);
  sodium_memzero(secret.data(), secret.size());
  return key;
}

BusKey::Tag BusKey::tag(std::initializer_list<ByteView> pieces) const {
  crypto_generichash_state state;
  Tag tag{};
  crypto_generichash_init(&state, secret_.data(), secret_.size(), tag.size());
  for (const ByteView piece : pieces) {
    crypto_generichash_update(&state, piece.data(), piece.size());
  }
  crypto_generichash_final(&state, tag.data(), tag.size());
  return tag;
}

void write_new_bus_key(const std::filesystem::path& path) {
  start_sodium();
  BusKey::Secret secret{};
  randombytes_buf(secret.data(), secret.size());
  const auto fail_writing = [&path](int error) {
    throw std::system_error(error, std::generic_category(),
                            "cannot write bus key '" + path.string() + "'");
  };
  // Others may read it at no moment, and no key that is in use is replaced.
  const Descriptor file(open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600));
  if (*file < 0) fail_writing(errno);
  errno = 0;
  const ssize_t written = write(*file, secret.data(), secret.size());
  const bool is_whole = written == static_cast<ssize_t>(secret.size()) && fsync(*file) == 0;
  const int error = errno == 0 ? ENOSPC : errno;  // 0: only a part was written
  sodium_memzero(secret.data(), secret.size());
  if (is_whole) return sync_folder(path.parent_path());
  unlink(path.c_str());
  fail_writing(error);
}

}  // namespace kintsugi
