/* platform/windows/include/poll.h - declares POSIX's poll() for one descriptor that is read. */
#ifndef HL_PLATFORM_WINDOWS_POLL_H
#define HL_PLATFORM_WINDOWS_POLL_H

#define POLLIN 1

struct pollfd {
  int fd;
  short events, revents;
};

/* Waits until a pipe has bytes or has ended. Files other than pipes are always ready. count: must be 1. */
int poll(struct pollfd *wanted, unsigned count, int milliseconds);

#endif
