/* platform/windows/include/alloca.h - memory of a function's frame, which Windows declares elsewhere. */
#ifndef HL_PLATFORM_WINDOWS_ALLOCA_H
#define HL_PLATFORM_WINDOWS_ALLOCA_H

#include <malloc.h>

#endif
