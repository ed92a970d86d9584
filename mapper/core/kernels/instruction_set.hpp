#pragma once

#include <array>
#include <string_view>

namespace kintsugi::mapper {

/// Which instructions the kernels may use. All give the same bytes.
enum class InstructionSet { kPortable, kAvx2, kAvx512 };

/// From the narrowest to the widest.
inline constexpr std::array kInstructionSets = {InstructionSet::kPortable, InstructionSet::kAvx2,
                                                InstructionSet::kAvx512};

/// The widest set that this processor and this build have, unless the environment variable
/// KINTSUGI_INSTRUCTION_SET (portable, avx2 or avx512) names another.
/// @throws std::runtime_error where the variable has another value, or names a set that this
/// processor or this build does not have
InstructionSet best_instruction_set();

bool is_supported(InstructionSet instruction_set);
std::string_view name_of(InstructionSet instruction_set);

}  // namespace kintsugi::mapper
