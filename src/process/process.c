/* process/process.c - starts, limits, awaits and ends a child. */
#define _GNU_SOURCE
#include "process.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
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

/* Starts the child. SIGPIPE, which this program may ignore, ends the child as usual. */
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
  problem = posix_spawnp(&p->child, words[0], actions, &attributes, (char *const *)words, environ);
  if (problem != 0) p->child = 0;
  posix_spawnattr_destroy(&attributes);
  return problem;
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
  prlimit(p->child, RLIMIT_AS, &of_memory, NULL);
  prlimit(p->child, RLIMIT_FSIZE, &of_file, NULL);
}

/* Waits for the child with the given flags of waitpid(), and notes whether the child has ended. */
static bool await(process *p, int flags, bool *succeeded) {
  int how = 0;
  pid_t ended;
  *succeeded = false;
  if (p->child <= 0) return true;
  while ((ended = waitpid(p->child, &how, flags)) < 0 && errno == EINTR) continue;
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

void process_said(process *p, const char *name, char *text, size_t size) {
  snprintf(text, size, "%s has failed", name);
  if (p->messages == NULL) return;
  rewind(p->messages);
  if (fgets(text, (int)size, p->messages) == NULL) snprintf(text, size, "%s has failed", name);
  text[strcspn(text, "\n")] = '\0';
}

void process_end(process *p) {
  if (p->child > 0) kill(p->child, SIGKILL);
  process_wait(p);
  if (p->messages != NULL) fclose(p->messages);
  p->messages = NULL;
}
