#pragma once

namespace kintsugi {

/// The version of this build, MAJOR.MINOR.PATCH: that of project() in the top CMakeLists.txt.
const char* version();

}  // namespace kintsugi
