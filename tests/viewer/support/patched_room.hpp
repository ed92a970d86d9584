#pragma once
// The synthetic room as a mapper with patches sees it.

#include "tests/viewer/support/synthetic_room.hpp"

namespace kintsugi::viewer {

/// make_room() in patches: tiles of 0.5 m that are sent again in batches, four a second, while the
/// camera discovers more of their surface; and what the camera sees, ten times a second, with depth
/// and colour. Some patches come in several revisions; the last one of each has left the volume.
/// The final slice tells their number.
SyntheticMap make_patched_room(double length_m, double resolution_m);

}  // namespace kintsugi::viewer
