#include "lcmtypes/base/service_notice.hpp"

#include <systemd/sd-daemon.h>

namespace kintsugi {

void tell_service_manager() {
  // The result is of no use: without systemd there is nobody to tell, and that is no fault.
  (void)sd_notify(0, "READY=1\nWATCHDOG=1");
}

}  // namespace kintsugi
