/* core/context.c - creates contexts, and implements their callbacks. */
#include "core/context.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "core/error.h"
#include "platform/memory.h"
#include "text/plain.h"

static void *default_allocate(void *user_data, size_t size, size_t alignment) {
  (void)user_data;
  size_t rounded = (size + alignment - 1) / alignment * alignment;
  if (rounded < size) return NULL;
  return hl_aligned_allocate(rounded, alignment);
}

static void default_release(void *user_data, void *memory) {
  (void)user_data;
  hl_aligned_release(memory);
}

void hl_context_options_defaults(hl_context_options *options) {
  if (options == NULL) return;
  memset(options, 0, sizeof *options);
  options->struct_size = sizeof *options;
}

/* The length of a text with its terminating zero; 0 for null. */
static size_t bytes_of(const char *text) { return text != NULL ? strlen(text) + 1 : 0; }

hl_status hl_context_create(const hl_context_options *options, hl_context **context, hl_error *error) {
  if (context == NULL) return hl_fail(error, HL_ERROR_ARGUMENT, "hl_context_create: context is null");
  *context = NULL;
  hl_context_options chosen;
  hl_context_options_defaults(&chosen);
  if (options != NULL) {
    if (options->struct_size != sizeof *options)
      return hl_fail(
          error, HL_ERROR_ARGUMENT,
          "hl_context_create: struct_size is %zu, expected %zu: call hl_context_options_defaults first",
          options->struct_size, sizeof *options);
    chosen = *options;
  }
  if ((chosen.allocate == NULL) != (chosen.release == NULL))
    return hl_fail(error, HL_ERROR_ARGUMENT, "hl_context_create: give both allocate and release, or neither");
  if (chosen.allocate == NULL) {
    chosen.allocate = default_allocate;
    chosen.release = default_release;
  }
  if (chosen.mpi < HL_MPI_AUTO || chosen.mpi > HL_MPI_MPICH)
    return hl_fail(error, HL_ERROR_ARGUMENT, "hl_context_create: mpi is %d, which is no hl_mpi",
                   (int)chosen.mpi);
  hl_instruction_set best = hl_cpu_best_instruction_set();
  if (chosen.instruction_set == HL_INSTRUCTION_SET_AUTO) chosen.instruction_set = best;
  if (!hl_cpu_has_instruction_set(chosen.instruction_set))
    return hl_fail(error, HL_ERROR_UNSUPPORTED,
                   "instruction set %s: this processor or build does not have it; its best is %s",
                   hl_instruction_set_name(chosen.instruction_set), hl_instruction_set_name(best));
  size_t data_bytes = bytes_of(chosen.data_folder), scratch_bytes = bytes_of(chosen.scratch_folder);
  size_t device_bytes = bytes_of(chosen.device), cache_bytes = bytes_of(chosen.cache_folder);
  hl_context *made = chosen.allocate(
      chosen.user_data, sizeof *made + data_bytes + scratch_bytes + device_bytes + cache_bytes, 64);
  if (made == NULL) return hl_fail_memory(error, sizeof *made, "a context");
  made->options = chosen;
  made->scratch_folder = NULL;
  char *texts = (char *)(made + 1);
  if (data_bytes > 0) made->options.data_folder = memcpy(texts, chosen.data_folder, data_bytes);
  if (scratch_bytes > 0)
    made->options.scratch_folder = memcpy(texts + data_bytes, chosen.scratch_folder, scratch_bytes);
  texts += data_bytes + scratch_bytes;
  if (device_bytes > 0) made->options.device = memcpy(texts, chosen.device, device_bytes);
  if (cache_bytes > 0)
    made->options.cache_folder = memcpy(texts + device_bytes, chosen.cache_folder, cache_bytes);
  atomic_init(&made->held, 0);
  atomic_init(&made->peak, 0);
  atomic_init(&made->paged, 0);
  made->ranks = NULL;
  made->whole = made;
  made->folder = -1;
  *context = made;
  return HL_OK;
}

hl_status hl_context_limit_memory(hl_context *context, uint64_t memory_limit, const char *scratch_folder,
                                  hl_error *error) {
  if (context == NULL) return hl_fail(error, HL_ERROR_ARGUMENT, "hl_context_limit_memory: context is null");
  if (hl_is_confined(context))
    return hl_fail(error, HL_ERROR_ARGUMENT,
                   "hl_context_limit_memory: context is confined: give the one that it was made of");
  hl_context_options *options = &context->options;
  size_t bytes = bytes_of(scratch_folder);
  char *copy = bytes > 0 ? options->allocate(options->user_data, bytes, 64) : NULL;
  if (copy == NULL && bytes > 0) return hl_fail_memory(error, bytes, "the name of a folder");
  if (copy != NULL) memcpy(copy, scratch_folder, bytes);
  if (context->scratch_folder != NULL) options->release(options->user_data, context->scratch_folder);
  options->scratch_folder = context->scratch_folder = copy;
  options->memory_limit = memory_limit;
  return HL_OK;
}

void hl_context_leave(hl_context *context) {
  if (atomic_fetch_sub(&context->users, 1) > 1) return;
  if (context->folder >= 0) close(context->folder);
  context->options.release(context->options.user_data, context);
}

void hl_context_destroy(hl_context *context) {
  if (context == NULL) return;
  if (hl_is_confined(context)) {
    hl_context_leave(context);
    return;
  }
  if (context->scratch_folder != NULL)
    context->options.release(context->options.user_data, context->scratch_folder);
  context->options.release(context->options.user_data, context);
}

uint64_t hl_context_memory_held(const hl_context *context) {
  return context == NULL ? 0 : atomic_load(&context->whole->held);
}

uint64_t hl_context_memory_peak(const hl_context *context) {
  return context == NULL ? 0 : atomic_load(&context->whole->peak);
}

hl_instruction_set hl_context_instruction_set(const hl_context *context) {
  return context == NULL ? HL_INSTRUCTION_SET_AUTO : context->options.instruction_set;
}

void hl_log(const hl_context *context, hl_log_level level, const char *format, ...) {
  if (context->options.log == NULL) return;
  char line[1000];
  va_list arguments;
  va_start(arguments, format);
  hl_plain_vprint(line, sizeof line, format, arguments);
  va_end(arguments);
  hl_make_printable(line);
  context->options.log(context->options.user_data, level, line);
}

void hl_progress(const hl_context *context, const char *stage, double fraction) {
  if (context->options.progress != NULL)
    context->options.progress(context->options.user_data, stage, fraction);
}

bool hl_cancelled(const hl_context *context) {
  return context->options.cancelled != NULL && context->options.cancelled(context->options.user_data) != 0;
}
