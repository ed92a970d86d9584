// A log that goes on in further files, as a mapper writes it.

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lcmtypes/log/log_writer.hpp"
#include "lcmtypes/log/session_log.hpp"
#include "lcmtypes/log/whole_log_reader.hpp"
#include "tests/support/temporary_folder.hpp"

namespace kintsugi {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

class WholeLog : public ::testing::Test {
 protected:
  void write(int number, const std::vector<std::string>& channels, const Bytes& data = {1}) const {
    LogWriter log = LogWriter::create(numbered(path_, number));
    for (const std::string& channel : channels) log.append(1'000, channel, data);
  }

  /// The channels of its events, in order, and then the damage, if there is some.
  std::vector<std::string> read() const {
    WholeLogReader log(path_);
    std::vector<std::string> channels;
    while (const auto event = log.next()) {
      EXPECT_EQ(event->index, std::ssize(channels));
      channels.push_back(event->channel);
    }
    if (log.damage()) channels.push_back(*log.damage());
    return channels;
  }

  testing::TemporaryFolder folder_;
  std::filesystem::path path_ = folder_ / "run.lcm";
};

TEST_F(WholeLog, GoesOnInTheFilesInWhichItsMapperHas) {
  write(0, {kOptionsChannel, "A"});
  write(2, {"C"});
  write(1, {"B", "B"});
  EXPECT_THAT(read(), ElementsAre(kOptionsChannel, "A", "B", "B", "C"));
}

TEST_F(WholeLog, OfADurableRunBeginsWithAMark) {
  write(0, {kMarkChannel, kOptionsChannel});
  write(1, {kMarkChannel, "B"});
  EXPECT_THAT(read(), ElementsAre(kMarkChannel, kOptionsChannel, kMarkChannel, "B"));
}

TEST_F(WholeLog, OfLcmLoggerIsOneFile) {
  write(0, {"A"});
  write(1, {kOptionsChannel, "B"});
  EXPECT_THAT(read(), ElementsAre("A"));
}

/// Its mapper was killed before it could remove what a base has replaced.
TEST_F(WholeLog, WithABaseGoesOnBehindWhatThatHasReplaced) {
  write(0, {kBaseChannel}, base_before(3));
  for (const int number : {1, 2, 3, 4}) write(number, {std::to_string(number)});
  EXPECT_THAT(read(), ElementsAre(kBaseChannel, "3", "4"));
}

TEST_F(WholeLog, LacksNoFile) {
  write(0, {kOptionsChannel});
  write(2, {"C"});
  EXPECT_THAT([&] { read(); }, ThrowsMessage<std::runtime_error>(HasSubstr(
                                   "run.1.lcm' is missing, '" + numbered(path_, 2).string())));
}

TEST_F(WholeLog, TakesNoOtherNamesForNumbers) {
  write(0, {kOptionsChannel});
  for (const char* name : {"run.01.lcm", "run.1x.lcm", "run..lcm", "run.-1.lcm", "run.1"}) {
    std::ofstream(folder_ / name) << "other";
  }
  EXPECT_THAT(read(), ElementsAre(kOptionsChannel));
}

TEST_F(WholeLog, EndsWithItsFirstDamage) {
  write(0, {kOptionsChannel});
  write(1, {"B", "B"});
  write(2, {"C"});
  std::filesystem::resize_file(numbered(path_, 1), 40);
  EXPECT_THAT(read(), ElementsAre(kOptionsChannel, "B", HasSubstr("run.1.lcm")));
}

/// Its mapper was killed when it had created the next file.
TEST_F(WholeLog, MayEndWithAnEmptyFile) {
  write(0, {kOptionsChannel});
  write(1, {});
  EXPECT_THAT(read(), ElementsAre(kOptionsChannel));
}

}  // namespace
}  // namespace kintsugi
