#include <set>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lcmtypes/channels.hpp"
#include "lcmtypes/signing/signed_message.hpp"
#include "tests/support/hexadecimal.hpp"

namespace kintsugi {
namespace {

using signed_message::kSignatureBytes;
using signed_message::Parts;
using testing::hexadecimal;

const Bytes kMessage = {1, 2, 3, 4, 5};
constexpr std::uint64_t kSession = 0x0102030405060708;

std::shared_ptr<const BusKey> key() {
  static const auto shared = std::make_shared<const BusKey>(BusKey::Secret{7});
  return shared;
}

// Computed with Python's hashlib:
//   blake2b(b"KINTSIG1" + struct.pack("<QQ", session, sequence) + channel + b"\0" + message,
//           key=bytes(range(32)), digest_size=16)
TEST(SignedMessage, HasTheTagThatOthersCompute) {
  BusKey::Secret secret{};
  for (std::size_t i = 0; i < secret.size(); ++i) secret.at(i) = static_cast<std::uint8_t>(i);
  const BusKey counting(secret);
  const Bytes word = {'k', 'i', 'n', 't', 's', 'u', 'g', 'i'};
  EXPECT_EQ(hexadecimal(signed_message::tag(counting, "CLOUD_SLICE", kSession, 42, word)),
            "609da71e9333e098d901a7eeabde0414");
  EXPECT_EQ(hexadecimal(signed_message::tag(counting, "X", std::uint64_t{1} << 63U, 1, {})),
            "790720c55ebf530194b073db48f0dda2");
  Bytes large(100'000);
  for (std::size_t i = 0; i < large.size(); ++i) large[i] = static_cast<std::uint8_t>(i % 251);
  EXPECT_EQ(hexadecimal(signed_message::tag(counting, "X", std::uint64_t{1} << 63U, 1, large)),
            "988a957f8ef28d84d8038deaccaa86a1");
}

TEST(SignedMessage, HasATagThatDependsOnAllOfIt) {
  const auto tag_of = [](const std::string& channel, std::uint64_t session, std::int64_t sequence,
                         const Bytes& message) {
    return signed_message::tag(*key(), channel, session, sequence, message);
  };
  const BusKey::Tag tag = tag_of("A", 1, 2, {'B', 'C'});
  EXPECT_EQ(tag_of("A", 1, 2, {'B', 'C'}), tag);
  EXPECT_NE(tag_of("D", 1, 2, {'B', 'C'}), tag);
  EXPECT_NE(tag_of("A", 2, 1, {'B', 'C'}), tag);
  EXPECT_NE(tag_of("A", 1, 3, {'B', 'C'}), tag);
  EXPECT_NE(tag_of("AB", 1, 2, {'C'}), tag);  // where the channel ends is signed, too
}

TEST(SignedMessage, IsTheMessageAndItsSignature) {
  const Bytes data = signed_message::sign(*key(), "X", kSession, 258, kMessage);
  ASSERT_EQ(data.size(), kMessage.size() + kSignatureBytes);
  EXPECT_TRUE(std::equal(kMessage.begin(), kMessage.end(), data.begin()));
  const std::string session(data.begin() + 5, data.begin() + 13);
  EXPECT_EQ(session, "\x08\x07\x06\x05\x04\x03\x02\x01");
  EXPECT_EQ(std::string(data.begin() + 13, data.begin() + 21),
            std::string("\x02\x01\0\0\0\0\0\0", 8));
  EXPECT_EQ(std::string(data.end() - 8, data.end()), "KINTSIG1");
  const auto parts = signed_message::split(data);
  ASSERT_TRUE(parts);
  EXPECT_TRUE(std::ranges::equal(parts->message, kMessage));
  EXPECT_EQ(parts->session, kSession);
  EXPECT_EQ(parts->sequence, 258);
  EXPECT_TRUE(is_genuine(*key(), "X", *parts));
}

TEST(SignedMessage, OfNoBytesIsOne) {
  const auto parts = signed_message::split(signed_message::sign(*key(), "X", 1, 1, {}));
  ASSERT_TRUE(parts);
  EXPECT_TRUE(parts->message.empty());
}

TEST(SignedMessage, IsNotGenuineWithAnyBitChanged) {
  const Bytes data = signed_message::sign(*key(), "X", kSession, 258, kMessage);
  for (std::size_t bit = 0; bit < 8 * data.size(); ++bit) {
    Bytes changed = data;
    changed[bit / 8] ^= static_cast<std::uint8_t>(1U << bit % 8);
    const auto parts = signed_message::split(changed);
    EXPECT_FALSE(parts && is_genuine(*key(), "X", *parts)) << bit;
  }
}

TEST(SignedMessage, IsNotGenuineWhenCutOrProlonged) {
  const Bytes data = signed_message::sign(*key(), "X", kSession, 258, kMessage);
  const auto is_genuine_message = [](const Bytes& bytes) {
    const auto parts = signed_message::split(bytes);
    return parts && is_genuine(*key(), "X", *parts);
  };
  for (std::size_t size = 0; size < data.size(); ++size) {
    EXPECT_FALSE(is_genuine_message({data.begin(), data.begin() + static_cast<int>(size)}));
    EXPECT_FALSE(is_genuine_message({data.begin() + 1 + static_cast<int>(size), data.end()}));
  }
  Bytes longer = data;
  longer.insert(longer.begin(), 0);
  EXPECT_FALSE(is_genuine_message(longer));
  longer = data;
  longer.push_back(0);
  EXPECT_FALSE(is_genuine_message(longer));
}

TEST(SignedMessage, IsNotGenuineOnAnotherChannelOrWithAnotherKey) {
  const Bytes data = signed_message::sign(*key(), "X", kSession, 1, kMessage);
  const auto parts = signed_message::split(data);
  EXPECT_FALSE(is_genuine(*key(), "Y", *parts));
  EXPECT_FALSE(is_genuine(BusKey(BusKey::Secret{8}), "X", *parts));
}

// LCM sends a message of up to one datagram with 8 bytes and the channel before it.
TEST(SignedMessage, FitsIntoOneEthernetFrameOnEveryChannel) {
  using namespace channels;
  constexpr std::size_t kEthernetPayload = 1500;
  constexpr std::size_t kIpAndUdp = 28;
  constexpr std::size_t kLcm = 8;
  for (const std::string channel :
       {kCloudSlice, kCameraPose, kCameraView, kKeyframe, kRgbdFrame, kSegmentUpdate, kSegmentQuery,
        kSegmentAnswer, kSnapshot, kObjectDetection, kChangeReport, kMapperStatus, kSegmenterStatus,
        kViewerStatus, kDetectorStatus, kHeartbeat, kResendRequest, kChunksReplaced}) {
    EXPECT_LE(kIpAndUdp + kLcm + channel.size() + 1 + kMinMaxChunkBytes + kSignatureBytes,
              kEthernetPayload)
        << channel;
  }
}

TEST(MessageSigner, GivesEachMessageANumberOfItsOwn) {
  MessageSigner signer(key());
  std::vector<std::vector<Parts>> parts(4);
  std::vector<std::vector<Bytes>> data(4);
  {
    std::vector<std::jthread> threads;
    for (auto& of_thread : data) {
      threads.emplace_back([&signer, &of_thread] {
        for (int i = 0; i < 250; ++i) of_thread.push_back(signer.sign("X", kMessage));
      });
    }
  }
  std::set<std::int64_t> numbers;
  std::set<std::uint64_t> sessions;
  for (const auto& of_thread : data) {
    for (const Bytes& bytes : of_thread) {
      const auto found = signed_message::split(bytes);
      ASSERT_TRUE(found && is_genuine(*key(), "X", *found));
      numbers.insert(found->sequence);
      sessions.insert(found->session);
    }
  }
  EXPECT_EQ(sessions.size(), 1U);
  EXPECT_EQ(numbers.size(), 1000U);
  EXPECT_EQ(*numbers.begin(), 1);
  EXPECT_EQ(*numbers.rbegin(), 1000);
}

TEST(MessageSigner, BeginsANewSessionAfterALongSilence) {
  MessageSigner signer(key());
  const auto start = MessageSigner::Clock::now();
  const auto parts_at = [&](std::chrono::seconds time) {
    const Bytes data = signer.sign("X", kMessage, start + time);
    return *signed_message::split(data);
  };
  const Parts first = parts_at(std::chrono::seconds(0));
  const Parts second = parts_at(std::chrono::seconds(600));
  const Parts third = parts_at(std::chrono::seconds(1201));
  EXPECT_EQ(second.session, first.session);
  EXPECT_EQ(second.sequence, 2);
  EXPECT_NE(third.session, first.session);
  EXPECT_EQ(third.sequence, 1);
}

TEST(MessageSigner, SessionsTellWhenTheyBegan) {
  const auto now_s = std::chrono::duration_cast<std::chrono::seconds>(
                         std::chrono::system_clock::now().time_since_epoch())
                         .count();
  const std::uint64_t session = signed_message::new_session();
  EXPECT_GE(signed_message::begin_s(session), now_s);
  EXPECT_LE(signed_message::begin_s(session), now_s + 60);
  EXPECT_NE(signed_message::new_session(), session);
}

}  // namespace
}  // namespace kintsugi
