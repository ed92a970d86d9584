#pragma once
// OpenNI2's driver interface; its header requires these two macros.

#define XN_NEW(type, ...) new type(__VA_ARGS__)
#define XN_DELETE(pointer) delete (pointer)

#include <Driver/OniDriverAPI.h>
