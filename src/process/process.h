/* process/process.h - another program, run as a child: started without a shell, waited for, ended. */
#ifndef HL_PROCESS_PROCESS_H
#define HL_PROCESS_PROCESS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <sys/types.h>

typedef struct process {
  pid_t child;    /* 0: it does not run */
  FILE *messages; /* what it says on standard error; owned */
} process;

/* Starts the program words[0], looked for in the PATH, with the words up to the null. input: becomes its
 * standard input; -1: an empty one. It runs in a process group of its own, so that Ctrl-C does not reach it,
 * and what it prints is thrown away. Returns 0 or an errno; process_end() is due in any case. */
int process_start(process *p, const char *const *words, int input);

/* The most bytes of memory that it may hold, and that each of its files may have. */
void process_limit(const process *p, uint64_t memory, uint64_t file);

/* Waits until it ends by itself. Whether it succeeded. */
bool process_wait(process *p);

/* Whether it has ended; *succeeded then tells how. Does not wait. */
bool process_has_ended(process *p, bool *succeeded);

/* The first line that it said; "NAME has failed" where it said nothing. */
void process_said(process *p, const char *name, char *text, size_t size);

/* Ends it, if it still runs, and releases what the process owns. */
void process_end(process *p);

#endif
