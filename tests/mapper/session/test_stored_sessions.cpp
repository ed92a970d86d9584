// What a mapper's log says about its sessions, when it is not the log it should be.

#include <stdexcept>
#include <string>

#include <gmock/gmock.h>

#include "lcmtypes/log/session_log.hpp"
#include "mapper/session/stored_sessions.hpp"

namespace kintsugi::mapper {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

void read_options(const std::string& text) {
  const Bytes bytes(text.begin(), text.end());
  StoredSessionReader reader;
  reader.read({0, 1'000, kOptionsChannel, bytes});
}

TEST(StoredSessionReader, RefusesOptionsThatAreNone) {
  for (const char* text :
       {"", "no json", "[1, 2]", "{}", R"({"session": 7})", R"({"session": "7", "options": {}})",
        R"({"session": 1e300, "options": {}})", R"({"session": 0, "options": {}})",
        R"({"session": -1, "options": {}})", R"({"session": 7, "options": {"a": 1}})",
        "{\"session\": 7, \"options\": {\"\xff\": \"\"}}"}) {
    EXPECT_THAT([&] { read_options(text); },
                ThrowsMessage<std::runtime_error>(HasSubstr("MAPPER_OPTIONS cannot be read")))
        << text;
  }
  EXPECT_NO_THROW(read_options(R"({"session": 7, "options": {"resolution": "0.01"}})"));
}

}  // namespace
}  // namespace kintsugi::mapper
