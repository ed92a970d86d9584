// What the thread sanitizer reports of libraries that are not ours, in every program that opens
// OpenNI2 devices: OpenNI2's events are mutexes that another thread unlocks, and GDAL, which comes
// with OpenCV's image codecs, takes two locks in both orders in one thread.

// The sanitizer looks for this very name. NOLINTBEGIN(bugprone-reserved-identifier)
extern "C" const char* __tsan_default_suppressions();

extern "C" const char* __tsan_default_suppressions() {
  return "mutex:libOpenNI2.so.0\n"
         "mutex:libOniFile.so.0\n"
         "deadlock:libgdal.so\n";
}
// NOLINTEND(bugprone-reserved-identifier)
