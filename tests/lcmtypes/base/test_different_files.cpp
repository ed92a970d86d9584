#include <fstream>
#include <stdexcept>

#include <gmock/gmock.h>

#include "lcmtypes/base/different_files.hpp"
#include "tests/support/temporary_folder.hpp"

namespace kintsugi {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

TEST(DifferentFiles, AreThoseThatAreNotOneByLinksOrOtherSpellings) {
  const testing::TemporaryFolder folder;
  std::ofstream(folder / "map") << "a";
  std::filesystem::create_symlink("map", folder / "link");
  EXPECT_TRUE(is_same_file(folder / "map", folder / "link"));
  EXPECT_TRUE(is_same_file("new.ply", "./new.ply"));
  EXPECT_FALSE(is_same_file(folder / "map", folder / "other"));
}

TEST(DifferentFiles, AreWhatIsWrittenAndWhatIsRead) {
  check_different({{"MAP", "m"}, {"--mesh", "m"}}, {{"--ply", "a"}, {"--json", ""}, {"--csv", ""}});
  EXPECT_THAT(
      [] {
        check_different({{"MAP", "m"}}, {{"--json", "./m"}});
      },
      ThrowsMessage<std::runtime_error>(
          HasSubstr("--json is ./m, the same file as that of MAP: give it another name")));
  EXPECT_THAT(
      [] {
        check_different({}, {{"--json", "z"}, {"--csv", "z"}});
      },
      ThrowsMessage<std::runtime_error>(HasSubstr("--csv is z, the same file as that of")));
}

}  // namespace
}  // namespace kintsugi
