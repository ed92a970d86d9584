#include <fstream>
#include <stdexcept>

#include <gmock/gmock.h>

#include "lcmtypes/base/output_files.hpp"
#include "tests/support/temporary_folder.hpp"

namespace kintsugi {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

TEST(OutputFiles, AreOneByLinksAndOtherSpellings) {
  const testing::TemporaryFolder folder;
  std::ofstream(folder / "map") << "a";
  std::filesystem::create_symlink("map", folder / "link");
  EXPECT_TRUE(is_same_file(folder / "map", folder / "link"));
  EXPECT_TRUE(is_same_file("new.ply", "./new.ply"));
  EXPECT_FALSE(is_same_file(folder / "map", folder / "other"));
}

TEST(OutputFiles, TakeThePlaceOfNoOther) {
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

TEST(OutputFiles, NeedAFolder) {
  const testing::TemporaryFolder folder;
  check_folder_of("");
  check_folder_of("here.ply");
  check_folder_of(folder / "new.ply");
  EXPECT_THAT([&] { check_folder_of(folder / "none" / "new.ply"); },
              ThrowsMessage<std::runtime_error>(HasSubstr("new.ply: there is no folder ")));
  EXPECT_THAT([&] { check_folder_of(folder.path()); },
              ThrowsMessage<std::runtime_error>(HasSubstr(": is a folder")));
}

}  // namespace
}  // namespace kintsugi
