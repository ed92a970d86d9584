// What the thread sanitizer reports of OpenNI2, in every program that opens its devices: its events
// are mutexes that another thread unlocks, and it takes the locks of its list of devices and of the
// event of a disconnection in both orders (ours are closed, and their threads ended, before it is
// shut down).

// The sanitizer looks for this very name. NOLINTBEGIN(bugprone-reserved-identifier)
extern "C" const char* __tsan_default_suppressions();

extern "C" const char* __tsan_default_suppressions() {
  return "mutex:libOpenNI2.so.0\n"
         "mutex:libOniFile.so.0\n"
         "deadlock:libOpenNI2.so.0\n";
}
// NOLINTEND(bugprone-reserved-identifier)
