#include "mapper/core/kernels/instruction_set.hpp"

#include <cstdlib>
#include <stdexcept>
#include <string>

namespace kintsugi::mapper {
namespace {

constexpr const char* kVariable = "KINTSUGI_INSTRUCTION_SET";

InstructionSet parse(std::string_view name) {
  for (const InstructionSet candidate : kInstructionSets) {
    if (name_of(candidate) != name) continue;
    if (is_supported(candidate)) return candidate;
    throw std::runtime_error(std::string(kVariable) + " is '" + std::string(name) +
                             "', which this processor or this build does not have");
  }
  throw std::runtime_error(std::string(kVariable) + " is '" + std::string(name) +
                           "', expected portable, avx2 or avx512");
}

}  // namespace

InstructionSet best_instruction_set() {
  if (const char* name = std::getenv(kVariable); name != nullptr && *name != '\0') {
    return parse(name);
  }
  InstructionSet best = InstructionSet::kPortable;
  for (const InstructionSet candidate : kInstructionSets) {
    if (is_supported(candidate)) best = candidate;
  }
  return best;
}

bool is_supported(InstructionSet instruction_set) {
  switch (instruction_set) {
    case InstructionSet::kPortable:
      return true;
#ifdef KINTSUGI_X86_KERNELS
    case InstructionSet::kAvx2:
      return __builtin_cpu_supports("avx2") != 0;
    case InstructionSet::kAvx512:
      return __builtin_cpu_supports("avx512f") != 0 && __builtin_cpu_supports("avx512bw") != 0 &&
             __builtin_cpu_supports("avx512dq") != 0 && __builtin_cpu_supports("avx512vl") != 0;
#endif
    default:
      return false;
  }
}

std::string_view name_of(InstructionSet instruction_set) {
  switch (instruction_set) {
    case InstructionSet::kPortable:
      return "portable";
    case InstructionSet::kAvx2:
      return "avx2";
    case InstructionSet::kAvx512:
      return "avx512";
  }
  return "unknown";
}

}  // namespace kintsugi::mapper
