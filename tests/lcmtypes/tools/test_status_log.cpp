#include <algorithm>
#include <cstdint>
#include <fstream>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lcmtypes/tools/status_log.hpp"
#include "tests/support/file_size_limit.hpp"
#include "tests/support/temporary_folder.hpp"

namespace kintsugi {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::SizeIs;
using ::testing::ThrowsMessage;

std::vector<std::string> lines_of(const std::filesystem::path& file) {
  std::vector<std::string> lines;
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

TEST(StatusLog, RefusesAnotherKindOfFileAndLeavesItAsItIs) {
  const testing::TemporaryFolder folder;
  const auto file = folder.path() / "run.lcm";
  std::ofstream(file) << "no statuses";
  EXPECT_THAT([&] { StatusLog log(file); },
              ThrowsMessage<std::runtime_error>(HasSubstr("run.lcm: is no log of statuses")));
  EXPECT_THAT(lines_of(file), ElementsAre("no statuses"));
}

TEST(StatusLog, HasALineForEachField) {
  const testing::TemporaryFolder folder;
  const auto file = folder.path() / "status.csv";
  StatusLog log(file);
  MapperStatus mapper;
  mapper.utime = 5;
  mapper.session = 1'795'297'648'789'758;  // a wall clock in microseconds: no digit may be lost
  mapper.finished = true;
  mapper.frame_p50_ms = 12.5;
  mapper.state = TrackingState::kLost;
  mapper.loss_reason = "too few inliers";
  log.append(mapper);
  SegmenterStatus segmenter;
  segmenter.utime = 6;
  segmenter.lag_slices = 3;
  segmenter.problem = "\"map\", full";
  log.append(segmenter);
  StatusLog(file).append(ViewerStatus{});  // appends to the file
  log.append(DetectorStatus{});

  const auto lines = lines_of(file);
  EXPECT_EQ(lines.front(), "utime_us,process,field,value");
  EXPECT_EQ(std::count(lines.begin(), lines.end(), lines.front()), 1);
  EXPECT_THAT(lines, Contains("5,mapper,session,1795297648789758"));
  EXPECT_THAT(lines, Contains("5,mapper,finished,1"));
  EXPECT_THAT(lines, Contains("5,mapper,frame_p50_ms,12.500000"));
  EXPECT_THAT(lines, Contains("5,mapper,state,\"lost\""));
  EXPECT_THAT(lines, Contains("5,mapper,loss_reason,\"too few inliers\""));
  EXPECT_THAT(lines, Contains("6,segmenter,lag_slices,3"));
  EXPECT_THAT(lines, Contains("6,segmenter,problem,\"\"\"map\"\", full\""));
  EXPECT_THAT(lines, Contains("0,viewer,memory_bytes,0"));
  EXPECT_THAT(lines, Contains("0,detector,cpu_share,0.000000"));
}

TEST(StatusLog, HasWithAPeriodTheFirstOneThenOneOfEachPeriodAndTheLast) {
  const testing::TemporaryFolder folder;
  const auto file = folder / "status.csv";
  {
    StatusLog log(file, 1.0);
    for (int i = 0; i <= 25; ++i) {
      ViewerStatus status;
      status.utime = std::int64_t{100'000} * i;
      log.append(status);
      SegmenterStatus other;
      other.utime = 1'000'000 + i;
      log.append(other);
    }
  }
  std::set<std::string> viewer;
  std::set<std::string> segmenter;
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    const std::string utime = line.substr(0, line.find(','));
    if (line.find(",viewer,") != std::string::npos) viewer.insert(utime);
    if (line.find(",segmenter,") != std::string::npos) segmenter.insert(utime);
  }
  EXPECT_EQ(viewer, (std::set<std::string>{"0", "1000000", "2000000", "2500000"}));
  EXPECT_EQ(segmenter, (std::set<std::string>{"1000000", "1000025"}));
}

TEST(StatusLog, GoesOnWhenTheClockIsSetBack) {
  const testing::TemporaryFolder folder;
  const auto file = folder / "status.csv";
  StatusLog log(file, 10.0);
  for (const std::int64_t utime_s : {3'600, 0, 5, 10}) {
    MapperStatus status;
    status.utime = 1'000'000 * utime_s;
    log.append(status);
  }
  EXPECT_THAT(lines_of(file), Contains("0,mapper,finished,0"));
  EXPECT_THAT(lines_of(file), Not(Contains("5000000,mapper,finished,0")));
  EXPECT_THAT(lines_of(file), Contains("10000000,mapper,finished,0"));
}

TEST(StatusLog, ThrowsWhenTheFileCannotBeWritten) {
  EXPECT_THROW(StatusLog("/nonexistent/status.csv"), std::runtime_error);
}

TEST(StatusLog, LeavesOutWhatAFullDiskDoesNotTakeAndGoesOnAfterwards) {
  const testing::TemporaryFolder folder;
  const auto file = folder.path() / "status.csv";
  StatusLog log(file);
  MapperStatus mapper;
  mapper.utime = 1;
  log.append(mapper);
  const auto lines = lines_of(file);
  mapper.utime = 2;
  {
    const testing::FileSizeLimit limit(std::filesystem::file_size(file) + 100);
    log.append(mapper);
    EXPECT_EQ(lines_of(file), lines) << "no half status";
  }
  mapper.utime = 3;
  log.append(mapper);
  EXPECT_THAT(lines_of(file), SizeIs(2 * lines.size() - 1)) << "the header once";
  EXPECT_THAT(lines_of(file), Contains("3,mapper,finished,0"));
  EXPECT_THAT(lines_of(file), Not(Contains("2,mapper,finished,0")));
}

}  // namespace
}  // namespace kintsugi
