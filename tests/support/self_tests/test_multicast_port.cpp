#include <chrono>
#include <thread>

#include <gmock/gmock.h>

#include "tests/support/multicast_port.hpp"
#include "tests/support/private_bus.hpp"

namespace kintsugi::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

constexpr char kOtherUrl[] = "udpm://239.255.76.67:7668?ttl=0";

class MulticastPortTest : public ::testing::Test {
 protected:
  void SetUp() override {
    static const auto why_not = enter_private_bus();
    if (why_not) GTEST_SKIP() << *why_not;
  }
};

/// On loopback a datagram has arrived when sending it has returned.
TEST_F(MulticastPortTest, HearsOthersButNotItself) {
  MulticastPort one(kPrivateBusUrl);
  MulticastPort two(kPrivateBusUrl);
  one.send(Bytes{1, 2, 3});
  two.send(Bytes(60'000, 7));
  EXPECT_EQ(two.receive(), (Bytes{1, 2, 3}));
  EXPECT_FALSE(two.receive().has_value());
  EXPECT_EQ(one.receive(), Bytes(60'000, 7));
  EXPECT_FALSE(one.receive().has_value());
}

TEST_F(MulticastPortTest, DoesNotHearAnotherPort) {
  MulticastPort here(kPrivateBusUrl);
  MulticastPort there(kOtherUrl);
  here.send(Bytes{1});
  EXPECT_FALSE(there.receive().has_value());
}

TEST_F(MulticastPortTest, CountsWhatTheReceiveBufferDidNotHold) {
  MulticastPort slow(kPrivateBusUrl);
  MulticastPort fast(kPrivateBusUrl);
  constexpr int kMore = 1000;  // 60 MB; a receive buffer is 4 MB at most
  for (int i = 0; i < kMore; ++i) fast.send(Bytes(60'000, 1));
  int received = 0;
  while (slow.receive()) ++received;
  fast.send(Bytes{2});  // tells of the losses before it
  ASSERT_TRUE(slow.receive().has_value());
  EXPECT_GT(slow.lost(), 0);
  EXPECT_EQ(received + slow.lost(), kMore);
}

TEST_F(MulticastPortTest, SaysWhatAUrlLooksLike) {
  for (const char* url : {"", "udpm://", "udpm://127.0.0.1:7667", "udpm://239.255.76.67:70000",
                          "file:///log", "udpm://239.255.76.67:7667?ttl=x"}) {
    EXPECT_THAT([&] { const MulticastPort port(url); },
                ThrowsMessage<std::invalid_argument>(HasSubstr("expected udpm://GROUP:PORT")))
        << url;
  }
}

}  // namespace
}  // namespace kintsugi::testing
