/* platform/windows/include/alloca.h - declares alloca(), which Windows declares in another header. */
#ifndef HL_PLATFORM_WINDOWS_ALLOCA_H
#define HL_PLATFORM_WINDOWS_ALLOCA_H

#include <malloc.h>

#endif
