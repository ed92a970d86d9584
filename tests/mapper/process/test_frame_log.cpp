#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include "mapper/process/frame_log.hpp"
#include "tests/support/temporary_folder.hpp"

namespace kintsugi::mapper {
namespace {

using kintsugi::testing::TemporaryFolder;
using ::testing::HasSubstr;

std::vector<std::string> lines_of(const std::filesystem::path& path) {
  std::ifstream in(path);
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

std::vector<std::string> cells_of(const std::string& line) {
  std::istringstream in(line);
  std::vector<std::string> cells;
  for (std::string cell; std::getline(in, cell, ',');) cells.push_back(cell);
  return cells;
}

std::string cell(const std::vector<std::string>& lines, std::size_t row, const std::string& name) {
  const auto header = cells_of(lines.at(0));
  const auto column = std::find(header.begin(), header.end(), name) - header.begin();
  return cells_of(lines.at(row)).at(static_cast<std::size_t>(column));
}

/// A limit on the size of files stands for a disk that fills up.
void append_to_a_file_that_cannot_grow(const std::filesystem::path& path) {
  FrameLog log(path);
  std::signal(SIGXFSZ, SIG_IGN);
  const rlimit limit{std::filesystem::file_size(path) + 10, RLIM_INFINITY};
  setrlimit(RLIMIT_FSIZE, &limit);
  for (int i = 0; i < 3; ++i) log.append({}, 0, {}, true, 0, {});
  std::exit(0);
}

TEST(FrameLog, HasALineForEachFrameAsSoonAsItIsAppended) {
  const TemporaryFolder folder;
  FrameLog log(folder / "frames.csv");
  RgbdFrame frame;
  frame.frame_index = 12;
  frame.utime = 1'341'836'537'655'691;
  TrackingResult tracking;
  tracking.state = TrackingState::kTracking;
  tracking.iterations = 9;
  tracking.quality.rms_m = 0.0015;
  FrameTimings timings;
  timings.stages.raycast_ms = 4.25;
  timings.cpu_ms = 31.5;
  log.append(frame, 3, tracking, true, 2, timings);

  // The log is still open: nothing waits in a buffer that a crash would lose.
  const auto lines = lines_of(folder / "frames.csv");
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_EQ(cells_of(lines[0]).size(), cells_of(lines[1]).size());
  EXPECT_EQ(cell(lines, 1, "frame_index"), "12");
  EXPECT_EQ(cell(lines, 1, "utime_us"), "1341836537655691");
  EXPECT_EQ(cell(lines, 1, "part"), "3");
  EXPECT_EQ(cell(lines, 1, "state"), "tracking");
  EXPECT_EQ(cell(lines, 1, "reason"), "");
  EXPECT_EQ(cell(lines, 1, "fused"), "1");
  EXPECT_EQ(cell(lines, 1, "raycast_ms"), "4.250");
  EXPECT_EQ(cell(lines, 1, "cpu_ms"), "31.500");
  EXPECT_EQ(cell(lines, 1, "rms_m"), "0.001500");
  EXPECT_EQ(cell(lines, 1, "iterations"), "9");
  EXPECT_EQ(cell(lines, 1, "slices"), "2");
  EXPECT_GT(std::stod(cell(lines, 1, "memory_mb")), 1.0);
}

TEST(FrameLog, SaysWhyAFrameIsLost) {
  const TemporaryFolder folder;
  FrameLog log(folder / "frames.csv");
  TrackingResult lost;
  lost.state = TrackingState::kLost;
  lost.loss_reason = LossReason::kLargeResidual;
  log.append({}, 0, lost, false, 0, {});
  lost.loss_reason.reset();
  log.append({}, 0, lost, false, 0, {});
  const auto lines = lines_of(folder / "frames.csv");
  EXPECT_EQ(cell(lines, 1, "reason"), to_string(LossReason::kLargeResidual));
  EXPECT_EQ(cell(lines, 1, "fused"), "0");
  EXPECT_EQ(cell(lines, 2, "reason"), "no given pose within 20 ms");
}

TEST(FrameLog, NamesAFileThatCannotBeWritten) {
  try {
    const FrameLog log("/no/such/folder/frames.csv");
    ADD_FAILURE() << "accepted";
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), HasSubstr("/no/such/folder/frames.csv: cannot be written: No such"));
  }
}

TEST(FrameLog, RefusesAFullDiskAtTheStart) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full";
  EXPECT_THROW(FrameLog("/dev/full"), std::runtime_error);
}

TEST(FrameLog, GoesOnWithoutAFileThatCannotGrow) {
  const TemporaryFolder folder;
  const auto path = folder / "frames.csv";
  EXPECT_EXIT(append_to_a_file_that_cannot_grow(path), ::testing::ExitedWithCode(0), "");
  EXPECT_LE(lines_of(path).size(), 2U);
}

}  // namespace
}  // namespace kintsugi::mapper
