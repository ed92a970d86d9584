#include <array>
#include <cstdlib>
#include <cstring>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include "lcmtypes/base/service_notice.hpp"
#include "tests/support/temporary_folder.hpp"

namespace kintsugi {
namespace {

TEST(ServiceNotice, SaysReadyAndAliveToTheSocketOfTheServiceManager) {
  const testing::TemporaryFolder folder;
  const std::string path = (folder / "notify").string();
  const int listener = socket(AF_UNIX, SOCK_DGRAM, 0);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::strncpy(address.sun_path, path.c_str(), sizeof(address.sun_path) - 1);
  ASSERT_EQ(bind(listener, reinterpret_cast<sockaddr*>(&address), sizeof(address)), 0);
  setenv("NOTIFY_SOCKET", path.c_str(), 1);
  for (int i = 0; i < 1000; ++i) tell_service_manager();
  unsetenv("NOTIFY_SOCKET");
  std::array<char, 256> text{};
  ASSERT_GT(recv(listener, text.data(), text.size() - 1, MSG_DONTWAIT), 0);
  std::array<char, 256> more{};
  int num_more = 0;
  while (recv(listener, more.data(), more.size(), MSG_DONTWAIT) > 0) ++num_more;
  EXPECT_LT(num_more, 100) << "it is told now and then, not each time";
  close(listener);
  EXPECT_THAT(text.data(), ::testing::AllOf(::testing::HasSubstr("READY=1"),
                                            ::testing::HasSubstr("WATCHDOG=1")));
}

TEST(ServiceNotice, WithoutAServiceManagerNothingHappens) {
  unsetenv("NOTIFY_SOCKET");
  tell_service_manager();
}

}  // namespace
}  // namespace kintsugi
