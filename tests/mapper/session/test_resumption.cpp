// Which sessions of a log a run continues, and the numbers of its parts.

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

TEST_F(ResumptionTest, NumbersThePartsOfARunWithoutGapsAndContinuesThemAll) {
  {
    SessionStore store(log(false));
    Resumption run(store, {.options = {}, .session = 7});
    EXPECT_EQ(run.session(), 7);
    EXPECT_EQ(run.begin_part(1), 8);
    EXPECT_EQ(run.begin_part(2), 9);
  }
  SessionStore store(log(true));
  ASSERT_EQ(store.sessions().size(), 3U);
  Resumption run(store, {.options = {}, .session = 7});
  EXPECT_EQ(run.session(), 7);
  EXPECT_EQ(run.begin_part(1), 8);
  EXPECT_EQ(run.begin_part(2), 9);
  EXPECT_EQ(run.begin_part(3), 10);
  EXPECT_THAT([&] { Resumption(store, {.options = {}, .session = 9}); },
              ThrowsMessage<std::runtime_error>(HasSubstr("the session to resume is 7")));
}

TEST_F(ResumptionTest, RefusesALogWithoutTheFirstPartsOfTheRun) {
  {
    SessionStore store(log(false));
    store.begin_session(7, {});
    store.begin_part(9, 2, {});
  }
  SessionStore store(log(true));
  EXPECT_THAT([&] { Resumption(store, {}); },
              ThrowsMessage<std::runtime_error>(HasSubstr("session 9 is part 2 of a run")));
}

TEST_F(ResumptionTest, RefusesAPartWhoseSessionIsAnotherRun) {
  {
    SessionStore store(log(false));
    store.begin_session(8, {});
    store.begin_session(7, {});
  }
  SessionStore store(log(true));
  Resumption run(store, {});
  EXPECT_THAT([&] { run.begin_part(1); },
              ThrowsMessage<std::runtime_error>(HasSubstr("needs session 8")));
}

}  // namespace
}  // namespace kintsugi::mapper
