#pragma once
// The names of files of a log that is called NAME.lcm, beside those of session_log.hpp.

#include <filesystem>

namespace kintsugi::mapper {

/// NAME.partial.lcm, as AtomicFile names files.
std::filesystem::path partial(const std::filesystem::path& path);

/// .NAME.base.lcm: a base until it is whole. A name that no user gives a log: it is replaced and
/// removed without a question.
std::filesystem::path base_in_work(const std::filesystem::path& path);

/// Removes what a rewriting of the log was killed before: the files that its base replaces, numbers
/// 1 to the one before `next`, and a base that was not whole.
void remove_left(const std::filesystem::path& path, int next);

}  // namespace kintsugi::mapper
