#include <algorithm>
#include <atomic>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <zlib.h>

#include "segmenter/objects/library/library_lock.hpp"
#include "segmenter/objects/library/object_check.hpp"
#include "segmenter/objects/library/object_files.hpp"
#include "segmenter/objects/library/object_json.hpp"
#include "segmenter/objects/library/object_library.hpp"
#include "segmenter/objects/library/object_name.hpp"
#include "tests/segmenter/objects/library/example_object.hpp"
#include "tests/support/allocation_limit.hpp"
#include "tests/support/file_size_limit.hpp"
#include "tests/support/temporary_folder.hpp"

namespace kintsugi::segmenter {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using testing::example_object;
using ::testing::HasSubstr;

std::string contents(const fs::path& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

void overwrite(const fs::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

void expect_equal(const KnownObject& a, const KnownObject& b) {
  EXPECT_EQ(a.model.name, b.model.name);
  EXPECT_EQ(a.model.resolution_m, b.model.resolution_m);
  EXPECT_EQ(a.model.has_up, b.model.has_up);
  EXPECT_EQ(a.model.points_O, b.model.points_O);
  EXPECT_EQ(a.model.views_O, b.model.views_O);
  EXPECT_EQ(a.model.times_taught, b.model.times_taught);
  EXPECT_EQ(a.wholeness, b.wholeness);
  EXPECT_EQ(a.lessons, b.lessons);
  for (const EngineParameter& parameter : kMapParameters) {
    EXPECT_EQ(a.model.parameters.*parameter.value, b.model.parameters.*parameter.value)
        << parameter.name;
  }
}

/// A library with a bottle, a cup and a mug.
class Library : public ::testing::Test {
 protected:
  Library() {
    for (const char* const name : {"mug", "cup", "bottle"}) write(name);
  }
  void write(const std::string& name) const { write_object(example_object(name), folder_.path()); }
  [[nodiscard]] ObjectLibrary read() const { return ObjectLibrary::read(folder_.path()); }

  /// Only the cup is refused, for this reason.
  void expect_cup_refused(const std::string& reason) const {
    const ObjectLibrary library = read();
    ASSERT_EQ(library.refusals().size(), 1U);
    EXPECT_EQ(library.refusals()[0].name, "cup");
    EXPECT_THAT(library.refusals()[0].reason, AllOf(HasSubstr(cup().string()), HasSubstr(reason)));
    EXPECT_NE(library.find("mug"), nullptr);
    EXPECT_NE(library.find("bottle"), nullptr);
    EXPECT_EQ(library.find("cup"), nullptr);
  }
  void expect_refused_with(const std::string& from, const std::string& to,
                           const std::string& reason) const {
    std::string text = contents(cup() / kObjectFile);
    const std::size_t at = text.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    overwrite(cup() / kObjectFile, text.replace(at, from.size(), to));
    expect_cup_refused(reason);
    write("cup");
  }
  [[nodiscard]] fs::path cup() const { return folder_ / "cup"; }

  kintsugi::testing::TemporaryFolder folder_;
};

TEST_F(Library, HasWhatWasWrittenByName) {
  const ObjectLibrary library = read();
  EXPECT_TRUE(library.refusals().empty());
  ASSERT_EQ(library.objects().size(), 3U);
  EXPECT_EQ(library.objects()[0].model.name, "bottle");
  EXPECT_EQ(library.objects()[2].model.name, "mug");
  expect_equal(*library.find("cup"), example_object("cup"));
  EXPECT_EQ(library.find("c"), nullptr);
}

TEST_F(Library, TheSameObjectGivesTheSameFiles) {
  const kintsugi::testing::TemporaryFolder other;
  write_object(example_object("cup"), other / "objects");  // the folder is made
  for (const char* const file : {kObjectFile, kModelFile}) {
    EXPECT_EQ(contents(cup() / file), contents(other / "objects" / "cup" / file));
  }
}

TEST_F(Library, OfAFolderThatIsAbsentHasNoObjects) {
  const ObjectLibrary library = ObjectLibrary::read(folder_ / "absent");
  EXPECT_TRUE(library.objects().empty());
  EXPECT_FALSE(library.has_changed());
  write_object(example_object("cup"), folder_ / "absent");
  EXPECT_TRUE(library.has_changed());
}

TEST_F(Library, IsNoFile) {
  overwrite(folder_ / "file", "");
  EXPECT_THROW(ObjectLibrary::read(folder_ / "file"), std::runtime_error);
}

TEST_F(Library, RefusesWhatIsMissingOrForeignByName) {
  fs::remove(cup() / kModelFile);
  expect_cup_refused("model.ply: no such file");
  fs::remove(cup() / kObjectFile);
  expect_cup_refused("object.json: no such file");
  fs::remove_all(cup());
  overwrite(cup(), "a file");
  expect_cup_refused("is no folder");
  fs::remove(cup());
  fs::create_directory(folder_ / "an object");
  const ObjectLibrary library = read();
  ASSERT_EQ(library.refusals().size(), 1U);
  EXPECT_THAT(library.refusals()[0].reason, HasSubstr("letters, digits"));
}

TEST_F(Library, RefusesTheFolderOfAnotherName) {
  fs::rename(cup(), folder_ / "cap");
  const ObjectLibrary library = read();
  ASSERT_EQ(library.refusals().size(), 1U);
  EXPECT_THAT(library.refusals()[0].reason,
              HasSubstr("the name is 'cup', expected that of the folder, 'cap'"));
}

TEST_F(Library, RefusesAKeyThatIsMissingOrWrongWithItsPlace) {
  expect_refused_with("\"version\": 1", "\"version\": 2", "has version 2");
  expect_refused_with("kintsugi object", "other", "is no object of a library");
  expect_refused_with("\"has_up\": true", "\"has_up\": 1", "key 'has_up': expected true or false");
  expect_refused_with("\"has_up\": true,", "", "the key 'has_up' is missing");
  expect_refused_with("\"times_taught\": 2", "\"times_taught\": 0", "key 'times_taught'");
  expect_refused_with("\"times_taught\": 2", "\"times_taught\": 18446744073709551615",
                      "key 'times_taught'");
  expect_refused_with("\"resolution_m\": 0.005", "\"resolution_m\": 1e300", "key 'resolution_m'");
  expect_refused_with("\"resolution_m\": 0.005", "\"resolution_m\": 1e999", "number overflow");
  expect_refused_with("\"resolution_m\": 0.005", "\"resolution_m\": -0.5", "resolution_m is -0.5");
  expect_refused_with("\"scale\":0.0013", "\"scale\":-1", "scale");
  expect_refused_with("\"wholeness\": 0.875", "\"wholeness\": 2", "wholeness is 2");
  expect_refused_with("\"points\": 240", "\"points\": 241", "has 240 points, expected 241");
  expect_refused_with("\"segments\":[12,", "\"segments\":[-12,", "key 'segments'");
  expect_refused_with("2023-11-14T", "yesterday", "key 'time'");
  expect_refused_with(",-1.0,", ",", "three numbers");
  expect_refused_with(",-1.0,", ",-9.0,", "the length of a view");
  expect_refused_with("\"model_crc32\": \"", "\"model_crc32\": \"x", "8 digits");
  expect_refused_with("\"cells\":\"9d8\"", "\"cells\":\"9d\"", "key 'cells': expected 3 hex");
  expect_refused_with("\"cells\":\"9d8\"", "\"cells\":\"9D8\"", "key 'cells': expected 3 hex");
  expect_refused_with("\"size\":[2,2,3]", "\"size\":[2,2]", "key 'size': expected three");
  expect_refused_with("\"size\":[2,2,3]", "\"size\":[2,2,17]", "key 'size'");
  expect_refused_with("\"cell_m\":0.05", "\"cell_m\":0", "key 'cell_m'");
  expect_refused_with("\"has_up\": true,", "\"has_up\": true", "line 10, column");
}

TEST_F(Library, RefusesAnObjectAsLargeAsARoom) {
  KnownObject large = example_object("cup");
  large.model.points_O.front().x = 12.0F;
  EXPECT_THAT([&] { check_object(large); }, ::testing::ThrowsMessage<std::runtime_error>(
                                                HasSubstr("half the diagonal of its box is 5.99")));
  large.model.points_O.front().x = 9.0F;
  check_object(large);
}

TEST_F(Library, EveryTruncationIsRefused) {
  for (const char* const file : {kObjectFile, kModelFile}) {
    const std::string whole = contents(cup() / file);
    for (std::size_t size = 0; size + 1 < whole.size(); size += 1 + whole.size() / 97) {
      overwrite(cup() / file, whole.substr(0, size));
      expect_cup_refused(file);
    }
    overwrite(cup() / file, whole);
  }
}

TEST_F(Library, EveryChangedByteOfTheModelIsRefused) {
  const std::string model = contents(cup() / kModelFile);
  const std::string json = contents(cup() / kObjectFile);
  for (std::size_t i = 0; i < model.size(); i += 7) {
    std::string damaged = model;
    damaged[i] = static_cast<char>(damaged[i] ^ 1);
    EXPECT_THROW(parse_object(json, damaged, cup()), std::runtime_error) << i;
  }
  EXPECT_NO_THROW(parse_object(json, model, cup()));
}

TEST_F(Library, SizesThatOnlyAFileClaimsTakeNoMemory) {
  for (const char* const file : {kModelFile, kObjectFile}) {
    fs::resize_file(cup() / file, std::uintmax_t{1} << 40U);  // a hole: it takes no disk
    EXPECT_LT(kintsugi::testing::allocated_by([&] { expect_cup_refused("bytes, at most"); }),
              std::size_t{1} << 20U);
    write("cup");
  }
  // As many points as there may be, in a file of a few.
  const std::string model = contents(cup() / kModelFile);
  std::string claims = model;
  claims.replace(claims.find("vertex 240"), 10, "vertex 2000000");
  const auto crc = static_cast<std::uint32_t>(
      crc32_z(0, reinterpret_cast<const Bytef*>(claims.data()), claims.size()));
  const std::string json = object_json(example_object("cup"), crc);
  EXPECT_LT(kintsugi::testing::allocated_by(
                [&] { EXPECT_THROW(parse_object(json, claims, cup()), std::runtime_error); }),
            std::size_t{1} << 20U);
}

TEST_F(Library, TakesWhatAPersonAddedToTheText) {
  std::string text = contents(cup() / kObjectFile);
  overwrite(cup() / kObjectFile, text.replace(text.find('{'), 1, "{ \"note\": \"Anna's\","));
  EXPECT_NE(read().find("cup"), nullptr);
}

TEST_F(Library, HasChangedWhenAnObjectCameWentOrChanged) {
  ObjectLibrary library = read();
  EXPECT_FALSE(library.has_changed());
  write("plate");
  EXPECT_TRUE(library.has_changed());
  library = read();
  remove_object("plate", folder_.path());
  EXPECT_TRUE(library.has_changed());
  library = read();
  write("cup");
  EXPECT_TRUE(library.has_changed());
  library = read();
  overwrite(cup() / kObjectFile, contents(cup() / kObjectFile) + " ");
  EXPECT_TRUE(library.has_changed());
  EXPECT_FALSE(read().has_changed());
}

TEST_F(Library, IsReadAgainAsItIsNow) {
  overwrite(folder_ / "bottle" / kModelFile, "damaged");
  const ObjectLibrary before = read();
  ASSERT_EQ(before.objects().size(), 2U);
  write("plate");
  write("bottle");
  KnownObject cup = example_object("cup");
  cup.model.times_taught = 7;
  write_object(cup, folder_.path());
  remove_object("mug", folder_.path());
  const ObjectLibrary now = ObjectLibrary::read(folder_.path(), before);
  EXPECT_FALSE(now.has_changed());
  EXPECT_TRUE(now.refusals().empty());
  ASSERT_EQ(now.objects().size(), 3U);
  expect_equal(*now.find("bottle"), example_object("bottle"));
  expect_equal(*now.find("cup"), cup);
  expect_equal(*now.find("plate"), example_object("plate"));
  const ObjectLibrary same = ObjectLibrary::read(folder_.path(), now);
  ASSERT_EQ(same.objects().size(), 3U);
  expect_equal(*same.find("cup"), cup);
}

TEST_F(Library, AFullDiskLeavesTheOlderObjectAndNothingElse) {
  const std::string before = contents(cup() / kModelFile);
  KnownObject larger = example_object("cup");
  larger.model.points_O.resize(20'000, larger.model.points_O[0]);
  {
    const kintsugi::testing::FileSizeLimit limit(100'000);
    EXPECT_THROW(write_object(larger, folder_.path()), std::runtime_error);
    larger.model.name = "plate";
    EXPECT_THROW(write_object(larger, folder_.path()), std::runtime_error);
  }
  EXPECT_EQ(contents(cup() / kModelFile), before);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_.path()), {}), 3);
}

TEST_F(Library, WhatAnInterruptedWriterLeftIsNoObject) {
  fs::create_directory(folder_ / ".plate.tmp");
  overwrite(folder_ / ".plate.tmp" / kModelFile, "half");
  EXPECT_EQ(read().objects().size(), 3U);
  EXPECT_TRUE(read().refusals().empty());
  write("plate");
  EXPECT_FALSE(fs::exists(folder_ / ".plate.tmp"));
  EXPECT_NE(read().find("plate"), nullptr);
}

TEST_F(Library, WithoutAnObjectHasTheOthers) {
  remove_object("cup", folder_.path());
  EXPECT_EQ(read().objects().size(), 2U);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_.path()), {}), 2);
  EXPECT_THROW(remove_object("cup", folder_.path()), std::runtime_error);
  EXPECT_THROW(remove_object("../mug", folder_.path()), std::runtime_error);
  overwrite(folder_ / "mug" / kObjectFile, "damaged");
  remove_object("mug", folder_.path());
  EXPECT_EQ(read().objects().size(), 1U);
}

TEST_F(Library, NoObjectThatCouldNotBeReadIsWritten) {
  const auto expect_not_written = [&](const KnownObject& object) {
    EXPECT_THROW(write_object(object, folder_.path()), std::runtime_error);
  };
  expect_not_written(example_object("../cup"));
  KnownObject object = example_object("plate");
  object.model.points_O.clear();
  expect_not_written(object);
  object = example_object("plate");
  object.model.points_O[7].nx = 2.0F;
  expect_not_written(object);
  object = example_object("plate");
  object.model.points_O[7].x = 1000.0F;
  expect_not_written(object);
  EXPECT_EQ(read().objects().size(), 3U);
}

TEST_F(Library, IsWholeForThoseWhoReadWhileItIsWritten) {
  std::thread writer([&] {
    for (int i = 0; i < 50; ++i) {
      KnownObject object = example_object("cup");
      object.model.points_O.resize(100 + i);
      write_object(object, folder_.path());
    }
  });
  for (int i = 0; i < 50; ++i) {
    const ObjectLibrary library = read();
    // Three times in a row in the middle of an exchange is possible, but then it says that it
    // has changed.
    EXPECT_TRUE(library.refusals().empty() || library.has_changed());
  }
  writer.join();
  EXPECT_EQ(read().objects().size(), 3U);
}

/// Of a program that was killed where two names cannot be exchanged.
TEST(LibraryLock, BringsBackWhatWasBeingReplaced) {
  const kintsugi::testing::TemporaryFolder folder;
  const std::filesystem::path library = folder / "objects";
  write_object(example_object("mug"), library);
  write_object(example_object("globe"), library);
  std::filesystem::rename(library / "mug", library / ".mug.old");
  std::filesystem::create_directory(library / ".globe.old");   // the new one is there
  std::filesystem::create_directory(library / ".GLOBE .old");  // no object's name
  EXPECT_EQ(ObjectLibrary::read(library).objects().size(), 1U);
  const LibraryLock lock(library);
  EXPECT_EQ(ObjectLibrary::read(library).objects().size(), 2U);
  EXPECT_FALSE(std::filesystem::exists(library / ".mug.old"));
  EXPECT_FALSE(std::filesystem::exists(library / ".globe.old"));
  EXPECT_TRUE(std::filesystem::exists(library / ".GLOBE .old"));
}

TEST(LibraryLock, LetsOneProgramChangeTheLibraryAtATime) {
  const kintsugi::testing::TemporaryFolder folder;
  // A sum in two steps, unprotected but for the lock. That it is one is not seen by the thread
  // sanitizer, since it is a file's.
  std::atomic<int> count = 0;
  const auto work = [&] {
    for (int i = 0; i < 200; ++i) {
      const LibraryLock lock(folder / "objects");
      const int before = count;
      std::this_thread::yield();
      count = before + 1;
    }
  };
  std::thread other(work);
  work();
  other.join();
  EXPECT_EQ(count, 400);
}

TEST(ObjectName, IsThatOfAFolderWithoutSurprises) {
  for (const char* const name : {"mug", "Mug_2", "a-b", "0", "_x"}) {
    EXPECT_FALSE(reason_to_refuse_name(name).has_value()) << name;
  }
  EXPECT_FALSE(reason_to_refuse_name(std::string(64, 'a')).has_value());
  EXPECT_TRUE(reason_to_refuse_name(std::string(65, 'a')).has_value());
  for (const char* const name :
       {"", "-x", ".", "..", "a/b", "a b", "tasse\n", "t\xc3\xa4sse", "a.tmp"}) {
    EXPECT_TRUE(reason_to_refuse_name(name).has_value()) << name;
  }
}

TEST(ObjectJson, WithANumberThatIsTooLargeIsRefusedAsOtherText) {
  EXPECT_THROW(parse_object_json("{\"points\": 1e999}"), std::runtime_error);
}

TEST(ObjectJson, OfADeepOrCrowdedTextEndsSoon) {
  EXPECT_THROW(parse_object_json(std::string(1'000'000, '[')), std::runtime_error);
  std::string keys = "{";
  for (int i = 0; i < 100'000; ++i) keys += "\"" + std::to_string(i) + "\":0,";
  EXPECT_THROW(parse_object_json(keys + "\"a\":0}"), std::runtime_error);
}

}  // namespace
}  // namespace kintsugi::segmenter
