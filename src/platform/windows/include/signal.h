/* platform/windows/include/signal.h - extends <signal.h> by POSIX's names. Threads have no masks of
 * signals. */
#ifndef HL_PLATFORM_WINDOWS_SIGNAL_H
#define HL_PLATFORM_WINDOWS_SIGNAL_H

#include_next <signal.h>

#include <pthread.h>

typedef unsigned long long sigset_t;

#define SIGHUP      1
#define SIGPIPE     13
#define SIGXFSZ     25
#define SIG_SETMASK 2
#define SA_RESTART  0

struct sigaction {
  void (*sa_handler)(int);
  int sa_flags;
  sigset_t sa_mask;
};
int sigfillset(sigset_t *signals);
int sigemptyset(sigset_t *signals);
/* Sets the effect of a signal. The function fails for signals that the C library does not have. */
int sigaction(int number, const struct sigaction *action, struct sigaction *before);

#undef pthread_sigmask
int pthread_sigmask(int how, const sigset_t *signals, sigset_t *before);
/* Sets the effect of a signal. Ignoring a signal that Windows does not have is no error. */
void (*hl_posix_signal(int number, void (*handler)(int)))(int);
#define signal hl_posix_signal

#endif
