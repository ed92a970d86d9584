#pragma once
// Reads PLY files into tables.

#include <string>
#include <string_view>

#include "segmenter/io/points/point_roles.hpp"
#include "segmenter/io/points/point_table.hpp"

namespace kintsugi::segmenter {

/// What of a PLY file besides its vertices is kept.
enum class OtherElements { kSkip, kKeep };

/// Reads ascii and binary PLY of either byte order: every property of element `vertex`, of lists
/// the length. Other elements are skipped or kept, but must be complete.
///
/// @param bytes of the file; `name` stands for it in errors
/// @param labels which columns are checked before the data are read: find_roles()
/// @throws std::runtime_error naming the file, the place (line, byte offset) and what was expected:
///   a bad header, a count that the file cannot hold, what find_roles() throws for, values that are
///   not numbers, data that end early or do not end where the header says
PointTable parse_ply_table(std::string_view bytes, const std::string& name,
                           LabelUse labels = LabelUse::kRead,
                           OtherElements others = OtherElements::kSkip);

}  // namespace kintsugi::segmenter
