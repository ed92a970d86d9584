#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "lcmtypes/base/json_text.hpp"

namespace kintsugi {
namespace {

TEST(JsonText, ReplacesBytesThatAreNoUtf8) {
  const nlohmann::json json = {{"name", "caf\xe9.map"}, {"count", 2}};
  EXPECT_EQ(json_text(json), R"({"count":2,"name":"caf)"
                             "\xEF\xBF\xBD"
                             R"(.map"})");
  EXPECT_EQ(json_text(nlohmann::json{{"a", 1}}, 1), "{\n \"a\": 1\n}");
}

}  // namespace
}  // namespace kintsugi
