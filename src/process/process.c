/* process/process.c - starts, limits, awaits and ends a child process. */
#define _GNU_SOURCE
#include "process.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <signal.h>
#include <spawn.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

extern char **environ;

static void redirect(posix_spawn_file_actions_t *actions, const process *p, int input) {
  if (input >= 0) posix_spawn_file_actions_adddup2(actions, input, STDIN_FILENO);
  else posix_spawn_file_actions_addopen(actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_adddup2(actions, fileno(p->messages), STDERR_FILENO);
}

/* Starts the child. The child gets the default effect of SIGPIPE, which this program may ignore. */
static int spawn(process *p, const char *const *words, const posix_spawn_file_actions_t *actions) {
  posix_spawnattr_t attributes;
  sigset_t usual;
  int problem = posix_spawnattr_init(&attributes);
  if (problem != 0) return problem;
  sigemptyset(&usual);
  sigaddset(&usual, SIGPIPE);
  posix_spawnattr_setsigdefault(&attributes, &usual);
  posix_spawnattr_setpgroup(&attributes, 0);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGDEF);
  pid_t child;
  problem = posix_spawnp(&child, words[0], actions, &attributes, (char *const *)words, environ);
  if (problem == 0) p->child = child;
  posix_spawnattr_destroy(&attributes);
  return problem;
}

bool process_is_there(const char *name) {
  char path[PATH_MAX];
  for (const char *at = getenv("PATH"); at != NULL && *at != '\0';) {
    int length = (int)strcspn(at, ":");
    snprintf(path, sizeof path, "%.*s/%s", length, at, name);
    if (length > 0 && access(path, X_OK) == 0) return true;
    at += length + (at[length] == ':');
  }
  return false;
}

int process_start(process *p, const char *const *words, int input) {
  posix_spawn_file_actions_t actions;
  *p = (process){0, tmpfile()};
  if (p->messages == NULL) return errno;
  int problem = posix_spawn_file_actions_init(&actions);
  if (problem != 0) return problem;
  redirect(&actions, p, input);
  problem = spawn(p, words, &actions);
  posix_spawn_file_actions_destroy(&actions);
  return problem;
}

void process_limit(const process *p, uint64_t memory, uint64_t file) {
  const struct rlimit of_memory = {memory, memory}, of_file = {file, file};
  if (p->child <= 0) return;
  prlimit((pid_t)p->child, RLIMIT_AS, &of_memory, NULL);
  prlimit((pid_t)p->child, RLIMIT_FSIZE, &of_file, NULL);
}

/* Waits for the child with the given flags of waitpid(), and stores whether the child has ended. */
static bool await(process *p, int flags, bool *succeeded) {
  int how = 0;
  pid_t ended;
  *succeeded = false;
  if (p->child <= 0) return true;
  while ((ended = waitpid((pid_t)p->child, &how, flags)) < 0 && errno == EINTR) continue;
  if (ended == 0) return false;
  *succeeded = ended == p->child && WIFEXITED(how) && WEXITSTATUS(how) == 0;
  p->child = 0;
  return true;
}

bool process_has_ended(process *p, bool *succeeded) { return await(p, WNOHANG, succeeded); }

bool process_wait(process *p) {
  bool succeeded;
  await(p, 0, &succeeded);
  return succeeded;
}

void process_end(process *p) {
  if (p->child > 0) kill((pid_t)p->child, SIGKILL);
  process_wait(p);
  if (p->messages != NULL) fclose(p->messages);
  p->messages = NULL;
}
