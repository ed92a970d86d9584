#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lcmtypes/log/log_reader.hpp"
#include "lcmtypes/log/log_writer.hpp"
#include "tests/support/temporary_folder.hpp"

namespace kintsugi {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::TemporaryFolder;

std::shared_ptr<const BusKey> key(std::uint8_t number = 1) {
  return std::make_shared<const BusKey>(BusKey::Secret{number});
}

class SignedLog : public ::testing::Test {
 protected:
  void add(const std::string& channel, const Bytes& data) { log_->append(++utime_, channel, data); }
  void add_signed(std::uint8_t number) { add("X", signer_.sign("X", Bytes{number})); }

  /// The first byte of each message that is read.
  std::vector<int> read(const MessageTrust& trust) {
    log_.reset();
    LogReader reader(path_, trust);
    std::vector<int> numbers;
    while (const auto event = reader.next()) {
      EXPECT_EQ(event->utime, event->index + 1);
      EXPECT_TRUE(trust.key == nullptr || event->data.size() == 1);
      numbers.push_back(event->data.front());
    }
    EXPECT_FALSE(reader.damage());
    EXPECT_EQ(reader.bytes_read(), static_cast<std::int64_t>(std::filesystem::file_size(path_)));
    return numbers;
  }
  std::string refusal(const MessageTrust& trust) {
    try {
      (void)read(trust);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "accepted";
  }

  TemporaryFolder folder_;
  std::filesystem::path path_ = folder_ / "run.lcm";
  std::optional<LogWriter> log_{LogWriter::create(path_)};
  MessageSigner signer_{key()};
  std::int64_t utime_ = 0;
};

TEST_F(SignedLog, IsReadWithItsKey) {
  for (const std::uint8_t number : {1, 2, 3}) add_signed(number);
  EXPECT_THAT(read({.key = key()}), ElementsAre(1, 2, 3));
  EXPECT_THAT(read({.key = key()}), ElementsAre(1, 2, 3));  // each reading begins anew
}

TEST_F(SignedLog, NeedsAKeyOrTrust) {
  add_signed(1);
  EXPECT_THAT(refusal({}), AllOf(HasSubstr("run.lcm' is signed"), HasSubstr("--trust-log")));
  EXPECT_THAT(read({.trusts_all = true}), ElementsAre(1));
}

TEST_F(SignedLog, NeedsTheRightKey) {
  add_signed(1);
  add_signed(2);
  EXPECT_THAT(refusal({.key = key(2)}),
              AllOf(HasSubstr("run.lcm' has no message that is signed with the key"),
                    HasSubstr("0 are not signed, 2 are signed otherwise")));
  EXPECT_THAT(read({.key = key(2), .trusts_all = true}), ElementsAre(1, 2));
}

TEST_F(SignedLog, MustBeSignedWhereThereIsAKey) {
  add("X", {1});
  EXPECT_THAT(refusal({.key = key()}), HasSubstr("1 are not signed, 0 are signed otherwise"));
  EXPECT_THAT(read({.key = key(), .trusts_all = true}), ElementsAre(1));
  EXPECT_THAT(read({}), ElementsAre(1));
}

// lcm-logger also records what every program on the bus has dropped.
TEST_F(SignedLog, LeavesOutWhatThoseOnTheBusHaveDropped) {
  add("X", {1});
  add("X", MessageSigner(key(2)).sign("X", Bytes{2}));
  const Bytes repeated = signer_.sign("X", Bytes{3});
  add("X", repeated);
  add("Y", signer_.sign("X", Bytes{4}));
  add("X", repeated);
  add_signed(5);
  add("X", {6});
  const RefusedMessages before = refused_by_process();
  ::testing::internal::CaptureStderr();
  log_.reset();
  LogReader reader(path_, {.key = key()});
  const auto third = reader.next();
  ASSERT_TRUE(third);
  EXPECT_EQ(third->index, 2);  // its number in the file
  EXPECT_EQ(third->data.front(), 3);
  EXPECT_EQ(reader.next()->data.front(), 5);
  EXPECT_FALSE(reader.next());
  EXPECT_THAT(::testing::internal::GetCapturedStderr(), HasSubstr("run.lcm': dropped a message"));
  const RefusedMessages after = refused_by_process();
  EXPECT_EQ(after.unsigned_ones - before.unsigned_ones, 2);
  EXPECT_EQ(after.forged - before.forged, 2);
  EXPECT_EQ(after.replayed - before.replayed, 1);
}

TEST_F(SignedLog, MayHoldTheSelfTestOfLcm) {
  add("LCM_SELF_TEST", {1});
  add_signed(2);
  const RefusedMessages before = refused_by_process();
  EXPECT_THAT(read({.key = key()}), ElementsAre(2));
  EXPECT_EQ(refused_by_process(), before);
  EXPECT_THAT(refusal({.key = key(2)}), HasSubstr("0 are not signed, 1 are signed otherwise"));
  EXPECT_THAT(refusal({}), HasSubstr("is signed"));
}

TEST_F(SignedLog, ThatBecomesSignedInTheMiddleIsAnErrorThere) {
  add("X", {1});
  add_signed(2);
  log_.reset();
  LogReader reader(path_, MessageTrust{});
  EXPECT_EQ(reader.next()->data.front(), 1);
  EXPECT_THROW((void)reader.next(), std::runtime_error);
}

TEST_F(SignedLog, TellsOfDamageAfterItsFirstEvent) {
  add_signed(1);
  log_.reset();
  std::ofstream(path_, std::ios::app) << "rest";
  LogReader reader(path_, {.key = key()});
  EXPECT_FALSE(reader.damage());
  EXPECT_TRUE(reader.next());
  EXPECT_FALSE(reader.next());
  EXPECT_TRUE(reader.damage());
  EXPECT_TRUE(reader.is_cut_off());
}

}  // namespace
}  // namespace kintsugi
