/* core/confine.c - makes contexts that open only files below a folder. core/file.c enforces this limit. */
#include <string.h>
#include <unistd.h>

#include "core/context.h"
#include "core/file.h"

hl_status hl_context_confine(hl_context *context, const char *folder, hl_context **confined,
                             hl_error *error) {
  if (context == NULL || confined == NULL)
    return hl_fail(error, HL_ERROR_ARGUMENT, "hl_context_confine: null context or confined");
  *confined = NULL;
  hl_context *whole = context->whole;
  int descriptor = -1;
  if (folder != NULL) {
    hl_status status = hl_folder_open(context, folder, &descriptor, error);
    if (status != HL_OK) return status;
  }
  hl_context *made = whole->options.allocate(whole->options.user_data, sizeof *made, 64);
  if (made == NULL) {
    if (descriptor >= 0) close(descriptor);
    return hl_fail_memory(error, sizeof *made, "a context");
  }
  memset(made, 0, sizeof *made);
  made->options = context->options;
  made->options.data_folder = NULL;
  made->options.reads = NULL;
  made->whole = whole;
  made->folder = descriptor;
  atomic_init(&made->users, 1);
  *confined = made;
  return HL_OK;
}
