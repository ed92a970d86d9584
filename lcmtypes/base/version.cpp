#include "lcmtypes/base/version.hpp"

namespace kintsugi {

// A function, so that a new version compiles only this file again.
const char* version() { return KINTSUGI_VERSION; }

}  // namespace kintsugi
