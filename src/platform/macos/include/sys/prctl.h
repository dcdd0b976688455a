/* platform/macos/include/sys/prctl.h - Linux's <sys/prctl.h>: calls have no effect here. */
#ifndef HL_PLATFORM_MACOS_SYS_PRCTL_H
#define HL_PLATFORM_MACOS_SYS_PRCTL_H

enum { PR_SET_TIMERSLACK };
static inline int prctl(int option, ...) { return option - option - 1; }

#endif
