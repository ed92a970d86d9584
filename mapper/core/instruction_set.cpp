#include "mapper/core/instruction_set.hpp"

#include <cstdlib>
#include <stdexcept>
#include <string>

namespace kintsugi::mapper {
namespace {

constexpr const char* kVariable = "KINTSUGI_INSTRUCTION_SET";
constexpr InstructionSet kAll[] = {InstructionSet::kPortable, InstructionSet::kAvx2};

InstructionSet parse(std::string_view name) {
  for (const InstructionSet candidate : kAll) {
    if (name_of(candidate) != name) continue;
    if (is_supported(candidate)) return candidate;
    throw std::runtime_error(std::string(kVariable) + " is '" + std::string(name) +
                             "', which this processor or this build does not have");
  }
  throw std::runtime_error(std::string(kVariable) + " is '" + std::string(name) +
                           "', expected portable or avx2");
}

}  // namespace

InstructionSet best_instruction_set() {
  if (const char* name = std::getenv(kVariable); name != nullptr && *name != '\0') {
    return parse(name);
  }
  return is_supported(InstructionSet::kAvx2) ? InstructionSet::kAvx2 : InstructionSet::kPortable;
}

bool is_supported(InstructionSet instruction_set) {
  switch (instruction_set) {
    case InstructionSet::kPortable:
      return true;
    case InstructionSet::kAvx2:
#ifdef KINTSUGI_X86_KERNELS
      return __builtin_cpu_supports("avx2") != 0;
#else
      return false;
#endif
  }
  return false;
}

std::string_view name_of(InstructionSet instruction_set) {
  return instruction_set == InstructionSet::kAvx2 ? "avx2" : "portable";
}

}  // namespace kintsugi::mapper
