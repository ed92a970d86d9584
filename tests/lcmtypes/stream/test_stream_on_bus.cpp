// Reliable streams over a real bus that loses messages, in a network namespace of their own.

#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <thread>

#include <gtest/gtest.h>

#include "lcmtypes/base/patient_clock.hpp"
#include "lcmtypes/bus/bus_thread.hpp"
#include "lcmtypes/channels.hpp"
#include "lcmtypes/stream/stream_publisher.hpp"
#include "lcmtypes/stream/stream_subscriber.hpp"
#include "tests/support/example_messages.hpp"
#include "tests/support/message_equality.hpp"
#include "tests/support/private_bus.hpp"

namespace kintsugi {
namespace {

using namespace testing;  // NOLINT: the examples and the private bus

constexpr int kNumSlices = 20;
constexpr int kNumPoints = 20'000;  // 640 kB: 11 datagrams

// Less than two datagrams fit: messages are lost while the receiver is busy.
constexpr char kTinyReceiveBuffer[] = "&recv_buf_size=65536";

bool becomes_true(const std::function<bool()>& condition) {
  for (int wait = 0; wait < 600 && !condition(); ++wait) {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  return condition();
}

/// A receiver of the stream, with its own connection and thread.
class Receiver {
 public:
  explicit Receiver(const std::string& url_options = "") : bus_(kPrivateBusUrl + url_options) {
    subscriber_.subscribe(bus_);
    thread_.emplace(bus_, [this] { subscriber_.ask(bus_, clock_.now_s()); });
  }

  bool has_all() const {
    return subscriber_.counts().messages_complete == kNumSlices && subscriber_.is_complete(42);
  }
  /// True if each slice was received once and unchanged.
  bool is_right() {
    thread_->stop();
    for (int id = 0; id < kNumSlices; ++id) {
      if (slices_.count(id) != 1) return false;
      if (!(slices_.find(id)->second == example_slice(kNumPoints, id))) return false;
    }
    return slices_.size() == kNumSlices;
  }
  StreamCounts counts() const { return subscriber_.counts(); }

 private:
  Bus bus_;
  PatientClock clock_;
  std::multimap<std::int32_t, CloudSlice> slices_;
  StreamSubscriber<CloudSlice> subscriber_{channels::kCloudSlice, [this](CloudSlice slice) {
                                             slices_.emplace(slice.id, std::move(slice));
                                           }};
  std::optional<BusThread> thread_;  // last: it is stopped before the rest is destroyed
};

/// A sender that is faster than a tiny receive buffer, and answers requests.
class Sender {
 public:
  explicit Sender(double rate_bytes_per_s = 100e6) {
    StreamPublisher::Config config;
    config.rate_bytes_per_s = rate_bytes_per_s;
    config.burst_bytes = 1'000'000;
    config.max_chunk_bytes = bus_.max_message_bytes();
    publisher_.emplace(bus_, channels::kCloudSlice, 42, config, &store_);
    publisher_->subscribe(bus_);
    thread_.emplace(bus_);
  }
  StreamPublisher& stream() { return *publisher_; }
  void publish_all() {
    for (int id = 0; id < kNumSlices; ++id) publisher_->publish(example_slice(kNumPoints, id));
    publisher_->flush();
  }

 private:
  Bus bus_{kPrivateBusUrl};
  RecentChunks store_{100'000'000};
  std::optional<StreamPublisher> publisher_;
  std::optional<BusThread> thread_;
};

class StreamOnBus : public ::testing::Test {
 protected:
  void SetUp() override {
    static const std::optional<std::string> why_not = enter_private_bus();
    if (why_not) GTEST_SKIP() << *why_not;
  }
};

TEST_F(StreamOnBus, TwoReceiversWithTinyBuffersMissNothing) {
  Receiver one(kTinyReceiveBuffer);
  Receiver other(kTinyReceiveBuffer);
  Sender sender;
  sender.publish_all();
  EXPECT_TRUE(becomes_true([&] { return one.has_all() && other.has_all(); }));
  EXPECT_GT(one.counts().requests_sent + other.counts().requests_sent, 0) << "nothing was lost";
  const auto counts = sender.stream().counts();
  RecordProperty("sent", static_cast<int>(counts.chunks_sent));
  RecordProperty("resent", static_cast<int>(counts.chunks_resent));
  EXPECT_TRUE(one.is_right());
  EXPECT_TRUE(other.is_right());
}

TEST_F(StreamOnBus, AReceiverThatJoinsAfterTheEndGetsEverything) {
  Sender sender;
  sender.publish_all();
  const double before_s = sender.stream().time_since_request_s();
  Receiver late;
  EXPECT_TRUE(becomes_true([&] { return late.has_all(); }));
  EXPECT_EQ(late.counts().chunks_given_up, 0);
  EXPECT_GE(before_s, 0.0);
  EXPECT_GT(sender.stream().counts().requests_received, 0);
  EXPECT_TRUE(late.is_right());
}

TEST_F(StreamOnBus, AReceiverThatJoinsInTheMiddleDoesNotDelayTheOther) {
  Receiver early(kTinyReceiveBuffer);
  Sender sender(20e6);
  std::thread publishing([&] { sender.publish_all(); });
  EXPECT_TRUE(becomes_true([&] { return early.counts().messages_complete > 5; }));
  Receiver late(kTinyReceiveBuffer);
  publishing.join();
  EXPECT_TRUE(becomes_true([&] { return early.has_all() && late.has_all(); }));
  EXPECT_TRUE(early.is_right());
  EXPECT_TRUE(late.is_right());
}

}  // namespace
}  // namespace kintsugi
