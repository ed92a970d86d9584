#pragma once

namespace kintsugi {

/// Tells systemd that this process is ready and works. To be called as often as one likes, by the
/// thread whose standstill is a fault: a service of Type=notify with WatchdogSec is started again
/// when these calls stop. At most four a second are passed on. Without systemd it does nothing.
void tell_service_manager();

}  // namespace kintsugi
