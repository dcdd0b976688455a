/* process/process.h - runs another program as a child process. The functions start the child without a shell,
 * wait for the child, and end it. */
#ifndef HL_PROCESS_PROCESS_H
#define HL_PROCESS_PROCESS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

typedef struct process {
  intptr_t child; /* the child's process number, on Windows its handle; 0 if no child runs */
  FILE *messages; /* owned; the child's standard error */
} process;

/* Starts the program words[0], which is searched in the PATH. words: the command line, null-terminated.
 * input: a descriptor that becomes the child's standard input; -1 for an empty input. The child runs in a
 * process group of its own, so that Ctrl-C does not end the child. The child's standard output is discarded.
 * Returns 0 or an errno. The caller must call process_end() even after a failure. */
int process_start(process *p, const char *const *words, int input);

/* Returns whether a program of this name is in the PATH. */
bool process_is_there(const char *name);

/* Limits a child: `memory` is the greatest number of bytes that the child may allocate, and `file` the
 * greatest length in bytes of each file that the child writes. */
void process_limit(const process *p, uint64_t memory, uint64_t file);

/* Waits until the child ends by itself. Returns whether the child succeeded. */
bool process_wait(process *p);

/* Finds out, without waiting, whether the child has ended. If the child has ended, *succeeded is set to
 * whether the child succeeded. */
bool process_has_ended(process *p, bool *succeeded);

/* Copies the first line that the child wrote to standard error, or "NAME has failed" if the child wrote
 * nothing. */
void process_said(process *p, const char *name, char *text, size_t size);

/* Ends the child, if it still runs, and releases the memory of the process. */
void process_end(process *p);

#endif
