// The list of fields of each status against its .lcm file and its struct. That none is missing is
// checked at compile time, in lcmtypes/codec/status.cpp.

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <regex>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "lcmtypes/statuses.hpp"

namespace kintsugi {
namespace {

/// The names of the fields behind the checksum, in the order of the .lcm file.
std::vector<std::string> fields_of_lcm_file(const std::string& process) {
  const std::filesystem::path folder(KINTSUGI_LCM_FILES);
  std::ifstream file(folder / ("kintsugi_" + process + "_status_t.lcm"));
  const std::regex field("^  [a-z0-9_]+ ([a-z0-9_]+);.*");
  std::vector<std::string> names;
  std::smatch match;
  for (std::string line; std::getline(file, line);) {
    if (std::regex_match(line, match, field) && match[1] != "checksum") names.push_back(match[1]);
  }
  return names;
}

template <class Status>
class StatusFields : public ::testing::Test {};
using Statuses = ::testing::Types<MapperStatus, SegmenterStatus, ViewerStatus, DetectorStatus>;
TYPED_TEST_SUITE(StatusFields, Statuses);

TYPED_TEST(StatusFields, HaveTheNamesAndTheOrderOfTheLcmFile) {
  std::vector<std::string> names;
  TypeParam::visit_fields([&names](const StatusField& field) { names.emplace_back(field.name); });
  EXPECT_EQ(names, fields_of_lcm_file(TypeParam::kProcess));
}

TYPED_TEST(StatusFields, HaveTheOrderOfTheStruct) {
  std::vector<const void*> places;
  const TypeParam status;
  TypeParam::visit_fields(
      [&places](const StatusField&, const auto& value) { places.push_back(&value); }, status);
  EXPECT_TRUE(std::ranges::is_sorted(places));
  EXPECT_EQ(std::ranges::adjacent_find(places), places.end()) << "a field is listed twice";
}

}  // namespace
}  // namespace kintsugi
