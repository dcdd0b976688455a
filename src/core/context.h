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
};

void hl_log(const hl_context *context, hl_log_level level, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
void hl_progress(const hl_context *context, const char *stage, double fraction);
bool hl_cancelled(const hl_context *context);

/* ---- What the processor and this build can do ---- */

hl_instruction_set hl_cpu_best_instruction_set(void);

/* Whether this build has the set's functions and this processor can run them. */
int hl_cpu_has_instruction_set(hl_instruction_set set);

#endif
