#include <cstdlib>
#include <stdexcept>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mapper/core/kernels/instruction_set.hpp"

namespace kintsugi::mapper {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

class InstructionSetVariable : public ::testing::Test {
 protected:
  static void set(const char* value) { setenv("KINTSUGI_INSTRUCTION_SET", value, 1); }
  void TearDown() override { unsetenv("KINTSUGI_INSTRUCTION_SET"); }
};

TEST_F(InstructionSetVariable, ForcesThePortablePath) {
  set("portable");
  EXPECT_EQ(best_instruction_set(), InstructionSet::kPortable);
}

TEST_F(InstructionSetVariable, IsIgnoredWhenEmpty) {
  const InstructionSet unforced = best_instruction_set();
  EXPECT_TRUE(is_supported(unforced));
  set("");
  EXPECT_EQ(best_instruction_set(), unforced);
}

TEST_F(InstructionSetVariable, MustNameOneThatThereIs) {
  set("avx9");
  EXPECT_THAT(
      [] { best_instruction_set(); },
      ThrowsMessage<std::runtime_error>(HasSubstr("'avx9', expected portable, avx2 or avx512")));
}

TEST_F(InstructionSetVariable, MustNameOneThatCanRun) {
  for (const InstructionSet instruction_set : kInstructionSets) {
    set(std::string(name_of(instruction_set)).c_str());
    if (is_supported(instruction_set)) {
      EXPECT_EQ(best_instruction_set(), instruction_set);
    } else {
      EXPECT_THROW(best_instruction_set(), std::runtime_error);
    }
  }
}

}  // namespace
}  // namespace kintsugi::mapper
