#pragma once

#include <string_view>

namespace kintsugi::mapper {

/// Which instructions the inner loops may use. All give the same bytes.
enum class InstructionSet { kPortable, kAvx2 };

/// The widest that this processor and this build have, unless the environment variable
/// KINTSUGI_INSTRUCTION_SET (portable, avx2) names another.
/// @throws std::runtime_error where the variable names none, or one that cannot run here
InstructionSet best_instruction_set();

bool is_supported(InstructionSet instruction_set);
std::string_view name_of(InstructionSet instruction_set);

}  // namespace kintsugi::mapper
