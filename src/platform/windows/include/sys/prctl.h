/* platform/windows/include/sys/prctl.h - declares Linux's prctl(), which does nothing on this system. */
#ifndef HL_PLATFORM_WINDOWS_SYS_PRCTL_H
#define HL_PLATFORM_WINDOWS_SYS_PRCTL_H

enum { PR_SET_TIMERSLACK };
static inline int prctl(int option, ...) { return option - option - 1; }

#endif
