/* core/context.h - defines the members of hl_context. */
#ifndef HL_CORE_CONTEXT_H
#define HL_CORE_CONTEXT_H

#include <stdatomic.h>
#include <stdbool.h>

#include <halflight/context.h>

struct hl_context {
  hl_context_options options;       /* the options; `allocate` and `release` are never null, and
                                     * `instruction_set` is never AUTO */
  atomic_uint_least64_t held, peak; /* held: number of bytes of the context's blocks of memory that are
                                     * currently allocated; peak: the greatest value of `held` so far */
  char *scratch_folder;             /* owned; the folder given to hl_context_limit_memory(); may be null */
  atomic_uint_least64_t paged;      /* number of bytes in memory of the pages of scratch files
                                     * (volume/store/pages.h) */
  struct hl_ranks *ranks;           /* borrowed; the ranks over which loaded volumes lie (halflight/ranks.h);
                                     * may be null */
  struct hl_context *whole; /* the context that counts this context's memory: for a confined context the
                             * context from which it was made, else the context itself */
  int folder;               /* a confined context's folder, as a descriptor; -1 if the context may open no
                             * file */
  atomic_size_t users;      /* for a confined context: its number of users, which are its owner and each of
                             * its blocks of memory */
};

/* Returns whether the context opens only files below a folder. */
static inline bool hl_is_confined(const hl_context *context) { return context->whole != context; }

/* Removes one user of a confined context. When the last user is removed, the context is destroyed. */
void hl_context_leave(hl_context *context);

void hl_log(const hl_context *context, hl_log_level level, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
void hl_progress(const hl_context *context, const char *stage, double fraction);
bool hl_cancelled(const hl_context *context);

/* ---- What the processor and this build can do ---- */

hl_instruction_set hl_cpu_best_instruction_set(void);

/* Returns whether this build has functions for the instruction set and this processor can run them. */
int hl_cpu_has_instruction_set(hl_instruction_set set);

#endif
