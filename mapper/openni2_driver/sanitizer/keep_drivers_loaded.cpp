// For the address sanitizer, in every program that opens OpenNI2 devices: its own drivers keep some
// objects for as long as they are loaded. When OpenNI2 has unloaded them, before the sanitizer
// looks for leaks, nobody knows these objects any more. So nothing is unloaded.

// Takes the place of the C library's for all libraries of the program.
extern "C" int dlclose(void* /*library*/) { return 0; }
