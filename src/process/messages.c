/* process/messages.c - reads the messages that a child process has written to its standard error. */
#include <string.h>

#include "process.h"

void process_said(process *p, const char *name, char *text, size_t size) {
  snprintf(text, size, "%s has failed", name);
  if (p->messages == NULL) return;
  rewind(p->messages);
  if (fgets(text, (int)size, p->messages) == NULL) snprintf(text, size, "%s has failed", name);
  text[strcspn(text, "\r\n")] = '\0';
}
