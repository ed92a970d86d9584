#pragma once
// OpenNI2's driver interface; its header wants these two from whoever includes it.

#define XN_NEW(type, ...) new type(__VA_ARGS__)
#define XN_DELETE(pointer) delete (pointer)

#include <Driver/OniDriverAPI.h>
