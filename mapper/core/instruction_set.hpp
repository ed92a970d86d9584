#pragma once

#include <string_view>

namespace kintsugi::mapper {

/// Which instructions the inner loops may use. All give the same bytes.
enum class InstructionSet { kPortable, kAvx2, kAvx512 };

/// What this processor has and this binary was built with, the best last chosen; the environment
/// variable KINTSUGI_INSTRUCTION_SET (portable, avx2, avx512) takes its place. Throws
/// std::runtime_error where the variable names none of these or one that cannot run here.
InstructionSet best_instruction_set();

bool is_supported(InstructionSet instruction_set);
std::string_view name_of(InstructionSet instruction_set);

}  // namespace kintsugi::mapper
