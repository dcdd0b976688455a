/* core/key.c - see key.h. */
#include "core/key.h"

#include <string.h>

#include "core/memory.h"

void hl_key_add(hl_key *key, const void *bytes, size_t count) {
  if (key->bytes != NULL && count > 0) memcpy(key->bytes + key->count, bytes, count);
  key->count += count;
}

hl_status hl_key_renew(hl_context *context, hl_key_write *write, const void *data, hl_key *kept, bool *same,
                       hl_error *error) {
  hl_key counted = {NULL, 0};
  write(data, &counted);
  hl_key fresh = {hl_allocate(context, counted.count, 1), 0};
  if (fresh.bytes == NULL) return hl_fail_memory(error, counted.count, "a key");
  write(data, &fresh);
  *same = kept->bytes != NULL && kept->count == fresh.count &&
          memcmp(kept->bytes, fresh.bytes, fresh.count) == 0;
  hl_key_release(context, kept);
  *kept = fresh;
  return HL_OK;
}

void hl_key_release(hl_context *context, hl_key *key) {
  hl_release(context, key->bytes);
  *key = (hl_key){0};
}
