// Signed messages over a real bus, in a network namespace of their own.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lcmtypes/bus/bus_thread.hpp"
#include "lcmtypes/channels.hpp"
#include "lcmtypes/stream/stream_publisher.hpp"
#include "lcmtypes/stream/stream_subscriber.hpp"
#include "tests/support/example_messages.hpp"
#include "tests/support/message_equality.hpp"
#include "tests/support/private_bus.hpp"
#include "tests/support/temporary_folder.hpp"

namespace kintsugi {
namespace {

using namespace testing;  // NOLINT: the examples
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

MessageTrust with_key(std::uint8_t number = 1) {
  return {.key = std::make_shared<const BusKey>(BusKey::Secret{number})};
}

class SignedBus : public ::testing::Test {
 protected:
  void SetUp() override {
    static const std::optional<std::string> why_not = enter_private_bus();
    if (why_not) GTEST_SKIP() << *why_not;
  }
};

/// Collects the messages on the channel X, which have one byte each; 0 is the last.
class Ears {
 public:
  explicit Ears(const MessageTrust& trust) : bus_(kPrivateBusUrl, trust) {
    bus_.subscribe(
        "X", [this](ByteView message) { heard_.emplace_back(message.begin(), message.end()); });
  }
  /// Everything up to the next message that has been received by `done`.
  template <class Done>
  void listen_until(const Done& done) {
    while (!done() && bus_.handle(std::chrono::seconds(10))) {
    }
  }
  void listen_to(std::size_t count) {
    listen_until([&] { return heard_.size() >= count; });
  }
  const std::vector<Bytes>& heard() const { return heard_; }
  const RefusedMessages& refused() const { return bus_.refused(); }
  Bus& bus() { return bus_; }

 private:
  Bus bus_;
  std::vector<Bytes> heard_;
};

TEST_F(SignedBus, CarriesWhatIsSignedAndNothingElse) {
  Ears ears(with_key());
  Bus friendly(kPrivateBusUrl, with_key());
  Bus keyless(kPrivateBusUrl, MessageTrust{});
  Bus otherwise(kPrivateBusUrl, with_key(2));
  keyless.publish("X", Bytes{1});
  otherwise.publish("X", Bytes{2});
  friendly.publish("X", Bytes{3});
  ears.bus().publish("X", Bytes{4});  // its own
  ears.listen_to(2);
  EXPECT_THAT(ears.heard(), ElementsAre(Bytes{3}, Bytes{4}));
  EXPECT_EQ(ears.refused(), (RefusedMessages{.unsigned_ones = 1, .forged = 1}));
}

TEST_F(SignedBus, WithoutAKeyCarriesTheBytesAsTheyAre) {
  Ears ears(MessageTrust{});
  Bus(kPrivateBusUrl, MessageTrust{}).publish("X", Bytes{1, 2, 3});
  Bus(kPrivateBusUrl, with_key()).publish("X", Bytes{4});
  ears.listen_to(2);
  ASSERT_EQ(ears.heard().size(), 2U);
  EXPECT_EQ(ears.heard()[0], (Bytes{1, 2, 3}));
  EXPECT_EQ(ears.heard()[1].size(), 1 + signed_message::kSignatureBytes);
}

TEST_F(SignedBus, DropsWhatIsPlayedAgain) {
  Ears recorder(MessageTrust{});
  Ears ears(with_key());
  Bus friendly(kPrivateBusUrl, with_key());
  friendly.publish("X", Bytes{1});
  friendly.publish("X", Bytes{2});
  recorder.listen_to(2);
  Bus player(kPrivateBusUrl, MessageTrust{});
  for (const Bytes& recorded : recorder.heard()) player.publish("X", recorded);
  friendly.publish("X", Bytes{3});
  ears.listen_to(3);
  EXPECT_THAT(ears.heard(), ElementsAre(Bytes{1}, Bytes{2}, Bytes{3}));
  EXPECT_EQ(ears.refused(), RefusedMessages{.replayed = 2});
  // Who has not heard them before cannot tell the recording from the senders.
  Ears later(with_key());
  for (const Bytes& recorded : recorder.heard()) player.publish("X", recorded);
  later.listen_to(2);
  EXPECT_THAT(later.heard(), ElementsAre(Bytes{1}, Bytes{2}));
}

TEST_F(SignedBus, TakesAMessageOnceForAllHandlersOfAChannel) {
  Bus bus(kPrivateBusUrl, with_key());
  std::vector<int> called;
  bus.subscribe("X", [&](ByteView) { called.push_back(1); });
  bus.subscribe("X", [&](ByteView) { called.push_back(2); });
  bus.publish("X", Bytes{1});
  while (called.size() < 2 && bus.handle(std::chrono::seconds(10))) {
  }
  EXPECT_THAT(called, ElementsAre(1, 2));
  EXPECT_EQ(bus.refused(), RefusedMessages());
}

TEST_F(SignedBus, CarriesAStreamOfChunksOfOneEthernetFrame) {
  Bus receiving(kPrivateBusUrl, with_key());
  std::vector<CloudSlice> received;
  StreamSubscriber<CloudSlice> subscriber(
      channels::kCloudSlice, [&](CloudSlice slice) { received.push_back(std::move(slice)); });
  subscriber.subscribe(receiving);
  Bus sending(kPrivateBusUrl, with_key());
  const CloudSlice slice = example_slice(3'000);
  StreamPublisher::Config config;
  config.max_chunk_bytes = kMinMaxChunkBytes;
  StreamPublisher publisher(sending, channels::kCloudSlice, slice.session, config);
  publisher.publish(slice);
  while (received.empty() && receiving.handle(std::chrono::seconds(10))) {
  }
  ASSERT_EQ(received.size(), 1U);
  EXPECT_TRUE(received[0] == slice);
  EXPECT_EQ(subscriber.counts().messages_bad, 0);
}

/// Reads a log as a bus, up to its end.
std::vector<Bytes> read_as_bus(const std::filesystem::path& log, const MessageTrust& trust) {
  Bus bus("file://" + log.string() + "?speed=0", trust);
  std::vector<Bytes> heard;
  bus.subscribe("X", [&](ByteView message) { heard.emplace_back(message.begin(), message.end()); });
  try {
    while (bus.handle(std::chrono::seconds(1))) {
    }
  } catch (const std::runtime_error& error) {
    if (std::string(error.what()).find("is lost") == std::string::npos) throw;  // its end
  }
  return heard;
}

TEST(SignedLogAsBus, IsVerifiedAndNeedsAKey) {
  const TemporaryFolder folder;
  const auto path = folder / "run.lcm";
  Bus("file://" + path.string() + "?mode=w", with_key()).publish("X", Bytes{1});
  EXPECT_THAT(read_as_bus(path, with_key()), ElementsAre(Bytes{1}));
  EXPECT_THAT(read_as_bus(path, with_key(2)), IsEmpty());
  EXPECT_THAT(read_as_bus(path, {.trusts_all = true}), ElementsAre(Bytes{1}));
  try {
    (void)read_as_bus(path, {});
    FAIL() << "read";
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), HasSubstr("is signed: give the key with --bus-key FILE"));
  }
}

}  // namespace
}  // namespace kintsugi
