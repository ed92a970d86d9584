// Objects are as they were before a power cut or as they were being written, whole.

#include <cstdlib>
#include <filesystem>
#include <random>
#include <span>

#include <gtest/gtest.h>

#include "segmenter/objects/library/library_lock.hpp"
#include "segmenter/objects/library/object_files.hpp"
#include "tests/segmenter/objects/library/example_object.hpp"
#include "tests/support/power_cut.hpp"
#include "tests/support/temporary_folder.hpp"

namespace kintsugi::segmenter {
namespace {

namespace fs = std::filesystem;
using kintsugi::testing::last_told;

constexpr int kTimesTaught = 5;

/// Run by the test below.
TEST(LibraryPowerCut, DISABLED_TeachesAndForgets) {
  const fs::path library = fs::path(std::getenv("FORGETFUL_DISK")) / "objects";
  const LibraryLock lock(library);
  KnownObject mug = testing::example_object("mug");
  for (mug.model.times_taught = 1; mug.model.times_taught <= kTimesTaught;
       ++mug.model.times_taught) {
    write_object(mug, library);
    kintsugi::testing::tell_others(static_cast<int>(mug.model.times_taught));
  }
  remove_object("mug", library);
  kintsugi::testing::tell_others(kTimesTaught + 1);
}

TEST(LibraryPowerCut, LeavesObjectsWhole) {
  const kintsugi::testing::TemporaryFolder folder;
  fs::create_directory(folder / "disk");
  ASSERT_EQ(kintsugi::testing::run_on_forgetful_disk("LibraryPowerCut.DISABLED_TeachesAndForgets",
                                                     folder / "disk", folder / "journal"),
            0);
  const kintsugi::testing::DiskJournal journal(folder / "journal");
  const std::span events = journal.events();
  ASSERT_EQ(last_told(events), kTimesTaught + 1);
  std::mt19937 random(4);
  for (int i = 0; i < 200; ++i) {
    const std::size_t num_events = random() % (events.size() + 1);
    SCOPED_TRACE("after event " + std::to_string(num_events));
    kintsugi::testing::cut_power(events.first(num_events), {}, random(), folder / "left");
    const int told = last_told(events.first(num_events));
    const fs::path mug = folder / "left" / "objects" / "mug";
    if (!fs::exists(mug)) {
      ASSERT_TRUE(told == 0 || told >= kTimesTaught) << told;
      continue;
    }
    ASSERT_LE(told, kTimesTaught) << "was forgotten";
    const auto taught = static_cast<int>(read_object(mug).model.times_taught);
    ASSERT_GE(taught, told);
    ASSERT_LE(taught, told + 1);
  }
}

}  // namespace
}  // namespace kintsugi::segmenter
