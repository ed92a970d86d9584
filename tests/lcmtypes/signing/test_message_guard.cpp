#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lcmtypes/signing/message_guard.hpp"

namespace kintsugi {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::internal::CaptureStderr;
using ::testing::internal::GetCapturedStderr;
using Source = MessageGuard::Source;

const Bytes kMessage = {1, 2, 3};

std::shared_ptr<const BusKey> key(std::uint8_t number = 1) {
  return std::make_shared<const BusKey>(BusKey::Secret{number});
}

bool is_message(const std::optional<ByteView>& opened) {
  return opened && std::ranges::equal(*opened, kMessage);
}

class GuardWithKey : public ::testing::Test {
 protected:
  void SetUp() override { CaptureStderr(); }
  void TearDown() override { GetCapturedStderr(); }

  MessageGuard guard_{{.key = key()}, Source::kBus, "udpm://here"};
  MessageSigner signer_{key()};
};

TEST_F(GuardWithKey, LetsSignedMessagesThroughOnce) {
  const Bytes data = signer_.sign("X", kMessage);
  EXPECT_TRUE(is_message(guard_.open("X", data)));
  EXPECT_FALSE(guard_.open("X", data));
  EXPECT_TRUE(is_message(guard_.open("X", signer_.sign("X", kMessage))));
  EXPECT_EQ(guard_.refused(), (RefusedMessages{.replayed = 1}));
}

TEST_F(GuardWithKey, RefusesWhatIsNotSignedAndWhatIsForged) {
  EXPECT_FALSE(guard_.open("X", kMessage));
  EXPECT_FALSE(guard_.open("X", {}));
  EXPECT_FALSE(guard_.open("Y", signer_.sign("X", kMessage)));
  EXPECT_FALSE(guard_.open("X", MessageSigner(key(2)).sign("X", kMessage)));
  EXPECT_EQ(guard_.refused(), (RefusedMessages{.unsigned_ones = 2, .forged = 2}));
}

TEST_F(GuardWithKey, AForgedMessageDoesNotUseUpTheNumberOfTheTrueOne) {
  const Bytes data = signer_.sign("X", kMessage);
  Bytes forged = data;
  forged[0] ^= 1U;
  EXPECT_FALSE(guard_.open("X", forged));
  EXPECT_TRUE(is_message(guard_.open("X", data)));
}

TEST_F(GuardWithKey, KnowsTheMessagesOfSeveralSendersApart) {
  MessageSigner other(key());
  EXPECT_TRUE(is_message(guard_.open("X", signer_.sign("X", kMessage))));
  EXPECT_TRUE(is_message(guard_.open("X", other.sign("X", kMessage))));
}

TEST_F(GuardWithKey, CountsForTheProcess) {
  const RefusedMessages before = refused_by_process();
  const Bytes data = signer_.sign("X", kMessage);
  (void)guard_.open("X", data);
  (void)guard_.open("X", data);
  (void)guard_.open("Y", data);
  (void)guard_.open("X", kMessage);
  struct {
    std::int64_t messages_unsigned = 0;
    std::int64_t messages_forged = 0;
    std::int64_t messages_replayed = 0;
  } status;
  report_refused(status);
  EXPECT_EQ(status.messages_unsigned, before.unsigned_ones + 1);
  EXPECT_EQ(status.messages_forged, before.forged + 1);
  EXPECT_EQ(status.messages_replayed, before.replayed + 1);
}

TEST(MessageGuard, WarnsOfTheFirstOfEachKindAndThenOnceAMinute) {
  MessageGuard guard({.key = key()}, Source::kBus, "udpm://here");
  const auto start = MessageGuard::Clock::now();
  const auto told = [&](std::chrono::seconds time, const Bytes& data) {
    CaptureStderr();
    EXPECT_FALSE(guard.open("X", data, start + time));
    return GetCapturedStderr();
  };
  const Bytes forged = MessageSigner(key(2)).sign("X", kMessage);
  EXPECT_THAT(told(std::chrono::seconds(0), kMessage),
              AllOf(HasSubstr("bus udpm://here: dropped a message on X: it is not signed"),
                    HasSubstr("so far 1 not signed, 0 forged, 0 replayed\n")));
  EXPECT_THAT(told(std::chrono::seconds(1), kMessage), IsEmpty());
  EXPECT_THAT(told(std::chrono::seconds(2), forged), HasSubstr("its tag is wrong"));
  EXPECT_THAT(told(std::chrono::seconds(61), kMessage), IsEmpty());
  EXPECT_THAT(told(std::chrono::seconds(62), kMessage),
              HasSubstr("so far 4 not signed, 1 forged, 0 replayed\n"));
}

TEST(MessageGuard, WithoutAKeyLetsEverythingThroughAsItIsAndWarnsOnceOfSignatures) {
  MessageGuard guard({}, Source::kBus, "udpm://here");
  CaptureStderr();
  EXPECT_TRUE(is_message(guard.open("X", kMessage)));
  EXPECT_THAT(GetCapturedStderr(), IsEmpty());
  CaptureStderr();
  const Bytes data = MessageSigner(key()).sign("X", kMessage);
  for (int i = 0; i < 2; ++i) {
    const auto opened = guard.open("X", data);
    ASSERT_TRUE(opened);
    EXPECT_TRUE(std::ranges::equal(*opened, data));
  }
  EXPECT_EQ(GetCapturedStderr(),
            "bus udpm://here: messages on X are signed and cannot be used without the key of the "
            "bus: --bus-key FILE\n");
  EXPECT_EQ(guard.refused(), RefusedMessages());
}

TEST(MessageGuard, WithoutAKeyASignedLogIsAnError) {
  MessageGuard guard({}, Source::kLog, "run.lcm");
  EXPECT_TRUE(is_message(guard.open("X", kMessage)));
  try {
    (void)guard.open("X", MessageSigner(key()).sign("X", kMessage));
    FAIL() << "let through";
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("log 'run.lcm' is signed"), HasSubstr("--bus-key"),
                                    HasSubstr("--trust-log")));
  }
}

TEST(MessageGuard, ThatTrustsAllCutsSignaturesOffAndVerifiesNothing) {
  for (const auto& with : {key(), std::shared_ptr<const BusKey>()}) {
    MessageGuard guard({.key = with, .trusts_all = true}, Source::kLog, "run.lcm");
    const Bytes data = MessageSigner(key(2)).sign("X", kMessage);
    EXPECT_TRUE(is_message(guard.open("X", kMessage)));
    EXPECT_TRUE(is_message(guard.open("X", data)));
    EXPECT_TRUE(is_message(guard.open("Y", data)));
    EXPECT_EQ(guard.refused(), RefusedMessages());
  }
}

}  // namespace
}  // namespace kintsugi
