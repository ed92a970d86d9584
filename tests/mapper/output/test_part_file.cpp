#include <gtest/gtest.h>

#include "mapper/output/part_file.hpp"

namespace kintsugi::mapper {
namespace {

TEST(PartFile, HasTheNumberOfThePartBeforeTheExtension) {
  EXPECT_EQ(part_file("out/cloud.ply", 0), "out/cloud.ply");
  EXPECT_EQ(part_file("out/cloud.ply", 1), "out/cloud.part1.ply");
  EXPECT_EQ(part_file("/a.b/run.2026.txt", 12), "/a.b/run.2026.part12.txt");
  EXPECT_EQ(part_file("path", 1), "path.part1");
}

}  // namespace
}  // namespace kintsugi::mapper
