#include <cstdlib>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mapper/source/openni2/device_listing.hpp"
#include "tests/mapper/openni2_driver/recording_folder.hpp"

namespace kintsugi::mapper {
namespace {

using test::RecordingFolder;
using testing::AllOf;
using testing::HasSubstr;

TEST(DeviceListing, TellsWhatADeviceOffers) {
  const RecordingFolder folder;
  const std::string uri = folder.uri() +
                          "?depth_modes=64x48@30,32x24@60&depth_units=1mm,100um,shift"
                          "&color=off&registration=switchable";
  EXPECT_EQ(list_devices(uri), uri + "\n  Kintsugi " + folder.path().filename().string() +
                                   "\n  depth         64x48@30 32x24@60"
                                   "\n  colour        none"
                                   "\n  registration  can be switched on\n");
}

TEST(DeviceListing, ListsEveryCameraThatIsPluggedIn) {
  const RecordingFolder one;
  const RecordingFolder two;
  setenv("KINTSUGI_CAMERAS", (one.uri() + " folder:///no/such " + two.uri()).c_str(), 1);
  const std::string list = list_devices("");
  unsetenv("KINTSUGI_CAMERAS");
  EXPECT_THAT(list, AllOf(HasSubstr(one.uri()), HasSubstr(two.uri()), HasSubstr("64x48@30")));
}

TEST(DeviceListing, SaysThatThereIsNone) {
  // Where tests run, no camera is plugged in; where one is, it is listed.
  EXPECT_THAT(list_devices(""),
              testing::AnyOf(HasSubstr("no camera is plugged in"), HasSubstr("  depth  ")));
}

TEST(DeviceListing, SaysWhyADeviceCannotBeOpened) {
  EXPECT_THAT(test::error_of<std::runtime_error>([] { list_devices("folder:///no/such/folder"); }),
              HasSubstr("no such file or folder"));
  EXPECT_THAT(test::error_of<std::runtime_error>([] { list_devices("./some.oni"); }),
              HasSubstr("./some.oni: is a recording"));
}

}  // namespace
}  // namespace kintsugi::mapper
