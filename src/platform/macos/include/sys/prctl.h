/* platform/macos/include/sys/prctl.h - declares Linux's prctl(), which has no effect on this system. */
#ifndef HL_PLATFORM_MACOS_SYS_PRCTL_H
#define HL_PLATFORM_MACOS_SYS_PRCTL_H

enum { PR_SET_TIMERSLACK };
static inline int prctl(int option, ...) { return option - option - 1; }

#endif
