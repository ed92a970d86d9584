// What the thread sanitizer reports of libraries that are not ours, in every program that opens
// OpenNI2 devices: OpenNI2's events are mutexes that another thread unlocks; it takes the locks of
// its list of devices and of the event of a disconnection in both orders (ours are closed, and
// their threads ended, before it is shut down); and GDAL, which comes with OpenCV's image codecs,
// takes two locks in both orders in one thread.

// The sanitizer looks for this very name. NOLINTBEGIN(bugprone-reserved-identifier)
extern "C" const char* __tsan_default_suppressions();

extern "C" const char* __tsan_default_suppressions() {
  return "mutex:libOpenNI2.so.0\n"
         "mutex:libOniFile.so.0\n"
         "deadlock:libOpenNI2.so.0\n"
         "deadlock:libgdal.so\n";
}
// NOLINTEND(bugprone-reserved-identifier)
