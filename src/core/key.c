/* core/key.c - see key.h. */
#include "core/key.h"

#include <string.h>

#include "core/memory.h"

void hl_key_add(hl_key *key, const void *bytes, size_t count) {
  if (key->bytes != NULL && count > 0) memcpy(key->bytes + key->count, bytes, count);
  key->count += count;
}

/* Stores doubles so that their bytes sort as the numbers do: the highest byte comes first. The bits of a
 * double, read as a whole number, grow with the double's magnitude. Therefore all bits of a negative number
 * are inverted, and only the sign bit of any other number. */
void hl_key_add_numbers(hl_key *key, const double *numbers, size_t count) {
  for (size_t n = 0; n < count; n++) {
    uint64_t bits;
    memcpy(&bits, &numbers[n], sizeof bits);
    bits ^= bits >> 63 != 0 ? UINT64_MAX : (uint64_t)1 << 63;
    unsigned char bytes[sizeof bits];
    for (size_t byte = 0; byte < sizeof bits; byte++) bytes[byte] = (unsigned char)(bits >> (56 - 8 * byte));
    hl_key_add(key, bytes, sizeof bytes);
  }
}

/* Computes a hash of the bytes: Fowler, Noll and Vo's FNV-1a, over words of 64 bits. Four sums are computed
 * side by side, so that the steps of one sum need not wait for the steps of another. */
uint64_t hl_key_mark(const void *bytes, size_t count) {
  enum { WORD = sizeof(uint64_t), SUMS = 4 };
  const uint64_t prime = 0x100000001b3u;
  uint64_t sums[SUMS] = {0xcbf29ce484222325u, 1, 2, 3};
  const unsigned char *from = bytes;
  for (size_t at = 0; at < count; at += WORD) {
    uint64_t word = 0, *sum = &sums[at / WORD % SUMS];
    memcpy(&word, from + at, count - at < WORD ? count - at : WORD);
    *sum = (*sum ^ word) * prime;
    *sum ^= *sum >> 32; /* mixes the bits, so that the high bits affect the low bits, too */
  }
  for (int s = 1; s < SUMS; s++) sums[0] = (sums[0] ^ sums[s]) * prime;
  return (sums[0] ^ count) * prime;
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
