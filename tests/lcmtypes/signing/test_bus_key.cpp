#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "lcmtypes/signing/bus_key.hpp"
#include "tests/support/file_size_limit.hpp"
#include "tests/support/hexadecimal.hpp"
#include "tests/support/temporary_folder.hpp"

namespace kintsugi {
namespace {

using testing::hexadecimal;
namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::TemporaryFolder;

BusKey counting_key() {
  BusKey::Secret secret{};
  for (std::size_t i = 0; i < secret.size(); ++i) secret.at(i) = static_cast<std::uint8_t>(i);
  return BusKey(secret);
}

Bytes bytes_of(const std::string& text) { return {text.begin(), text.end()}; }

void write(const fs::path& path, std::size_t size, fs::perms mode = fs::perms(0600)) {
  std::ofstream(path, std::ios::binary) << std::string(size, 'k');
  fs::permissions(path, mode);
}

std::string refusal(const fs::path& path) {
  try {
    (void)BusKey::read(path);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "read";
}

// Computed with Python's hashlib.blake2b(text, key=bytes(range(32)), digest_size=16).
TEST(BusKey, ComputesKeyedBlake2b) {
  const BusKey key = counting_key();
  EXPECT_EQ(hexadecimal(key.tag({})), "3daf97bce7888fd59773c66bf647459c");
  EXPECT_EQ(hexadecimal(key.tag({bytes_of("kintsugi")})), "0db2f657f61fa4c90a2a269f4e6237a6");
  EXPECT_EQ(key.tag({bytes_of("kint"), {}, bytes_of("sugi")}), key.tag({bytes_of("kintsugi")}));
  EXPECT_NE(BusKey(BusKey::Secret{}).tag({}), key.tag({}));
}

TEST(BusKey, IsMadeForItsOwnerAndReadBack) {
  const TemporaryFolder folder;
  write_new_bus_key(folder / "bus.key");
  write_new_bus_key(folder / "other.key");
  EXPECT_EQ(fs::file_size(folder / "bus.key"), BusKey::kBytes);
  EXPECT_EQ(fs::status(folder / "bus.key").permissions(), fs::perms(0600));
  const auto key = BusKey::read(folder / "bus.key");
  EXPECT_EQ(key->tag({}), BusKey::read(folder / "bus.key")->tag({}));
  EXPECT_NE(key->tag({}), BusKey::read(folder / "other.key")->tag({}));
}

TEST(BusKey, ReplacesNoFile) {
  const TemporaryFolder folder;
  write(folder / "bus.key", 5);
  EXPECT_THROW(write_new_bus_key(folder / "bus.key"), std::system_error);
  EXPECT_EQ(fs::file_size(folder / "bus.key"), 5U);
  EXPECT_THROW(write_new_bus_key(folder / "none" / "bus.key"), std::system_error);
}

TEST(BusKey, LeavesNoHalfOfAKeyOnAFullDisk) {
  const TemporaryFolder folder;
  {
    const testing::FileSizeLimit limit(BusKey::kBytes / 2);
    EXPECT_THROW(write_new_bus_key(folder / "bus.key"), std::system_error);
  }
  EXPECT_FALSE(fs::exists(folder / "bus.key"));
}

TEST(BusKey, RefusesFilesThatOthersMayUse) {
  const TemporaryFolder folder;
  for (const int mode : {0640, 0604, 0620, 0602, 0610, 0601, 0666, 0755}) {
    write(folder / "bus.key", BusKey::kBytes, fs::perms(mode));
    EXPECT_THAT(refusal(folder / "bus.key"),
                AllOf(HasSubstr("bus.key' has mode 0"), HasSubstr("expected 0600: chmod 600")));
  }
  for (const int mode : {0600, 0400}) {
    write(folder / std::to_string(mode), BusKey::kBytes, fs::perms(mode));
    EXPECT_EQ(refusal(folder / std::to_string(mode)), "read");
  }
}

TEST(BusKey, RefusesFilesOfAnotherSizeAndWhatIsNoFile) {
  const TemporaryFolder folder;
  for (const std::size_t size : {std::size_t{0}, BusKey::kBytes - 1, BusKey::kBytes + 1}) {
    write(folder / "bus.key", size);
    EXPECT_THAT(refusal(folder / "bus.key"),
                HasSubstr("has " + std::to_string(size) + " bytes, expected 32"));
  }
  EXPECT_THAT(refusal(folder / "none"), HasSubstr("No such file"));
  EXPECT_THAT(refusal(folder.path()), HasSubstr("is no file"));
  ASSERT_EQ(mkfifo((folder / "fifo").c_str(), 0600), 0);
  EXPECT_THAT(refusal(folder / "fifo"), HasSubstr("is no file"));
}

}  // namespace
}  // namespace kintsugi
