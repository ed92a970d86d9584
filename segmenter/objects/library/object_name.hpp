#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace kintsugi::segmenter {

inline constexpr std::size_t kMaxObjectName = 64;

/// Why an object cannot have this name, which is also that of a folder; nothing when it can: 1 to
/// kMaxObjectName letters, digits, '-' and '_' of ASCII, the first of which is not '-'.
std::optional<std::string> reason_to_refuse_name(std::string_view name);

}  // namespace kintsugi::segmenter
