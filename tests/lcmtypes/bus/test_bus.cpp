// Tests over a real bus, in their own network namespace. Under ctest each test is a process; if
// they run in one process, they enter the namespace once.

#include <atomic>
#include <cstdlib>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sched.h>

#include "lcmtypes/bus/bus_thread.hpp"
#include "lcmtypes/bus/message_subscriber.hpp"
#include "lcmtypes/channels.hpp"
#include "lcmtypes/stream/stream_publisher.hpp"
#include "lcmtypes/stream/stream_subscriber.hpp"
#include "tests/support/example_messages.hpp"
#include "tests/support/message_equality.hpp"
#include "tests/support/private_bus.hpp"

namespace kintsugi {
namespace {

using namespace testing;  // NOLINT: the examples
using ::testing::HasSubstr;
using ::testing::SizeIs;
using ::testing::ThrowsMessage;

class PrivateBus : public ::testing::Test {
 protected:
  void SetUp() override {
    static const std::optional<std::string> why_not = enter_private_bus();
    if (why_not) GTEST_SKIP() << *why_not;
  }
};

/// Handles messages until `done`, or until none was received for a long time.
template <class Done>
void handle_until(Bus& bus, const Done& done) {
  while (!done() && bus.handle(std::chrono::seconds(10))) {
  }
}

TEST_F(PrivateBus, CarriesSmallMessagesAndReportsBadOnes) {
  Bus bus(kPrivateBusUrl);
  std::vector<CameraPose> poses;
  std::vector<std::string> reasons;
  subscribe<CameraPose>(
      bus, channels::kCameraPose, [&](const CameraPose& pose) { poses.push_back(pose); },
      [&](const DecodeError& reason) { reasons.emplace_back(reason.what()); });
  bus.publish(channels::kCameraPose, Bytes{1, 2, 3});
  bus.publish(channels::kCameraPose, example_camera_pose());
  handle_until(bus, [&] { return !poses.empty(); });
  ASSERT_THAT(poses, SizeIs(1));
  EXPECT_TRUE(poses[0] == example_camera_pose());
  ASSERT_THAT(reasons, SizeIs(1));
  EXPECT_THAT(reasons[0], HasSubstr("camera_pose_t.size is 3"));
}

TEST_F(PrivateBus, LosesNothingOfAStreamWithADefaultReceiveBuffer) {
  // A new namespace has the kernel's default limit of receive buffers or inherits that of the
  // machine. In both cases the default size is requested.
  Bus receiving(std::string(kPrivateBusUrl) + "&recv_buf_size=212992");
  std::vector<CloudSlice> received;
  StreamSubscriber<CloudSlice> subscriber(
      channels::kCloudSlice, [&](CloudSlice slice) { received.push_back(std::move(slice)); });
  subscriber.subscribe(receiving);
  BusThread thread(receiving);

  Bus sending(kPrivateBusUrl);
  std::vector<CloudSlice> sent;
  {
    StreamPublisher publisher(sending, channels::kCloudSlice, 42, {});
    for (int id = 0; id < 10; ++id) {
      sent.push_back(example_slice(30'000, id));  // 1 MB
      publisher.publish(sent.back());
    }
    publisher.flush();
    for (int wait = 0; wait < 200 && subscriber.counts().messages_complete < 10; ++wait) {
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
  }
  thread.stop();
  const StreamCounts counts = subscriber.counts();
  EXPECT_EQ(counts.chunks_missing, 0);
  EXPECT_EQ(counts.messages_bad, 0);
  ASSERT_THAT(received, SizeIs(sent.size()));
  for (std::size_t i = 0; i < sent.size(); ++i) EXPECT_TRUE(received[i] == sent[i]);
}

TEST_F(PrivateBus, AHeartbeatTellsALateSubscriberWhatItMissed) {
  Bus sending(kPrivateBusUrl);
  StreamPublisher publisher(sending, channels::kCloudSlice, 42, {});
  publisher.publish(example_slice(10'000, 0));
  publisher.flush();
  const std::int64_t published = publisher.chunks_published();

  Bus receiving(kPrivateBusUrl);
  StreamSubscriber<CloudSlice> late(channels::kCloudSlice, [](const CloudSlice&) {});
  late.subscribe(receiving);
  handle_until(receiving, [&] { return late.counts().heartbeats > 0; });
  EXPECT_EQ(late.counts().chunks_missing, published);
  EXPECT_GT(published, 0);
}

TEST_F(PrivateBus, ThrowsTheExceptionOfAHandlerInTheReceivingThread) {
  Bus bus(kPrivateBusUrl);
  bus.subscribe("X", [](ByteView) { throw std::logic_error("from the handler"); });
  bus.publish("X", Bytes{1});
  EXPECT_THROW(handle_until(bus, [] { return false; }), std::logic_error);

  bus.publish("X", Bytes{1});
  BusThread thread(bus);
  for (int wait = 0; wait < 200 && !thread.failed(); ++wait) {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  EXPECT_THROW(thread.stop(), std::logic_error);
  EXPECT_NO_THROW(thread.stop());
}

TEST_F(PrivateBus, KnowsHowLargeAMessageMayBe) {
  EXPECT_EQ(Bus(kPrivateBusUrl).max_message_bytes(), kDefaultMaxChunkBytes);
  EXPECT_EQ(Bus("udpm://239.255.76.67:7667").max_message_bytes(), kDefaultMaxChunkBytes);
  EXPECT_EQ(Bus("udpm://239.255.76.67:7667?ttl=1").max_message_bytes(), kMinMaxChunkBytes);
  EXPECT_EQ(Bus("udpm://239.255.76.67:7667?recv_buf_size=9&ttl=12").max_message_bytes(),
            kMinMaxChunkBytes);
  EXPECT_EQ(Bus("file:///dev/null?mode=w").max_message_bytes(), kDefaultMaxChunkBytes);
}

TEST_F(PrivateBus, TicksBetweenMessagesAndWithoutMessages) {
  Bus bus(kPrivateBusUrl);
  std::atomic<int> ticks = 0;
  bus.subscribe("X", [&](ByteView) { bus.publish("X", Bytes{1}); });  // messages without pause
  BusThread thread(bus, [&] { ++ticks; });
  const auto has_ticked = [&](int number) {
    for (int wait = 0; wait < 200 && ticks < number; ++wait) {
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    return ticks >= number;
  };
  EXPECT_TRUE(has_ticked(3));
  bus.publish("X", Bytes{1});
  EXPECT_TRUE(has_ticked(ticks + 3));
  thread.stop();

  BusThread failing(bus, [] { throw std::logic_error("from the tick"); });
  for (int wait = 0; wait < 200 && !failing.failed(); ++wait) {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  EXPECT_THROW(failing.stop(), std::logic_error);
}

TEST_F(PrivateBus, YPublishesAgainAfterTheNetworkWasDown) {
  // In an inner namespace, whose loopback goes down while the bus is open.
  if (enter_private_bus()) GTEST_SKIP() << "no further network namespace here";
  Bus bus(kPrivateBusUrl);
  bus.publish("X", Bytes{1});
  ASSERT_TRUE(take_loopback_down());
  EXPECT_NO_THROW(bus.publish("X", Bytes{1}));
  ASSERT_TRUE(route_multicast_to_loopback());
  EXPECT_NO_THROW(bus.publish("X", Bytes{1}));
}

TEST_F(PrivateBus, ZReportsAMissingRoute) {
  // In an inner namespace, whose loopback is down.
  if (unshare(CLONE_NEWNET) != 0) GTEST_SKIP() << "no further network namespace here";
  try {
    Bus bus(kPrivateBusUrl);
    FAIL() << "opened";
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), HasSubstr("no route to 239.255.76.67. Add one for 224.0.0.0/4: ip "));
    EXPECT_THAT(error.what(), HasSubstr("ip route add 224.0.0.0/4 dev lo"));
  }
}

TEST_F(PrivateBus, ZLooksForTheRouteToTheGroupOfTheUrl) {
  // In an inner namespace, which has a route to one group only.
  if (unshare(CLONE_NEWNET) != 0) GTEST_SKIP() << "no further network namespace here";
  ASSERT_EQ(std::system("ip link set lo up && ip route add 239.1.2.3/32 dev lo"), 0);
  EXPECT_NO_THROW(Bus("udpm://239.1.2.3:7667?ttl=0"));
  EXPECT_THROW(Bus("udpm://239.255.76.67:7667?ttl=0"), std::runtime_error);
}

/// LCM would end the process when it waits.
TEST(Bus, RefusesAServerThatDoesNotAnswer) {
  EXPECT_THAT([] { Bus("tcpq://127.0.0.1:1"); },
              ThrowsMessage<std::runtime_error>(HasSubstr("nobody answers there")));
}

TEST(Bus, RefusesAnInvalidUrl) {
  try {
    Bus bus("nonsense://here");
    FAIL() << "opened";
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), HasSubstr("nonsense://here"));
    EXPECT_THAT(error.what(), HasSubstr("expected an LCM URL"));
  }
}

TEST(Bus, UsesTheUrlOfTheEnvironment) {
  setenv("LCM_DEFAULT_URL", "udpm://239.1.2.3:1234?ttl=0", 1);
  EXPECT_EQ(default_bus_url(), "udpm://239.1.2.3:1234?ttl=0");
  unsetenv("LCM_DEFAULT_URL");
  EXPECT_EQ(default_bus_url(), "udpm://239.255.76.67:7667?ttl=0");
}

}  // namespace
}  // namespace kintsugi
