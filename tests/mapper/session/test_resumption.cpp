// Which session of a log a run continues.

#include <stdexcept>

#include <gmock/gmock.h>

#include "mapper/session/resumption.hpp"
#include "tests/support/temporary_folder.hpp"

namespace kintsugi::mapper {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

class ResumptionTest : public ::testing::Test {
 protected:
  SessionStore::Config log(bool resume) const {
    SessionStore::Config config;
    config.path = folder_ / "run.lcm";
    config.resume = resume;
    return config;
  }

  const kintsugi::testing::TemporaryFolder folder_;
};

TEST_F(ResumptionTest, ContinuesTheLastRunOfTheLog) {
  {
    SessionStore store(log(false));
    Resumption run(store, {.options = {}, .session = 7});
    EXPECT_EQ(run.session(), 7);
  }
  SessionStore store(log(true));
  ASSERT_EQ(store.sessions().size(), 1U);
  Resumption run(store, {.options = {}, .session = 7});
  EXPECT_EQ(run.session(), 7);
  EXPECT_EQ(run.ended_session(), nullptr);
  EXPECT_THAT([&] { Resumption(store, {.options = {}, .session = 9}); },
              ThrowsMessage<std::runtime_error>(HasSubstr("the session to resume is 7")));
}

}  // namespace
}  // namespace kintsugi::mapper
