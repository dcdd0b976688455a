/* core/context.h - the inside of hl_context. */
#ifndef HL_CORE_CONTEXT_H
#define HL_CORE_CONTEXT_H

#include <stdatomic.h>
#include <stdbool.h>

#include <halflight/context.h>

struct hl_context {
  hl_context_options options;       /* callbacks filled in; instruction_set resolved */
  atomic_uint_least64_t held, peak; /* bytes of blocks */
  char *scratch_folder;             /* owned; of hl_context_limit_memory(); may be null */
  atomic_uint_least64_t paged;      /* bytes of the pages of scratch files (volume/pages.h) held in memory */
  struct hl_ranks *ranks;           /* borrowed: that hold what is loaded (halflight/ranks.h); may be null */
  struct hl_context *whole; /* of a confined context the one whose memory it takes; else the context itself */
  int folder;               /* of a confined context: its descriptor; -1: it opens no file */
  atomic_size_t users;      /* of a confined context: its owner, and the blocks of memory made with it */
};

/* Whether files are opened below a folder alone. */
static inline bool hl_is_confined(const hl_context *context) { return context->whole != context; }

/* One user less of a confined context, which goes with the last. */
void hl_context_leave(hl_context *context);

void hl_log(const hl_context *context, hl_log_level level, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
void hl_progress(const hl_context *context, const char *stage, double fraction);
bool hl_cancelled(const hl_context *context);

/* ---- What the processor and this build can do ---- */

hl_instruction_set hl_cpu_best_instruction_set(void);

/* Whether this build has the set's functions and this processor can run them. */
int hl_cpu_has_instruction_set(hl_instruction_set set);

#endif
