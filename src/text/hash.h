/* text/hash.h - computes the hash FNV-1a of 64 bits (Fowler, Noll, Vo), byte by byte. The hash of given bytes
 * is the same on every machine. */
#ifndef HL_TEXT_HASH_H
#define HL_TEXT_HASH_H

#include <stddef.h>
#include <stdint.h>

/* The hash of an empty sequence of bytes, with which a hash begins. A hash that begins with a different
 * number is independent of this hash. */
#define HL_HASH_BEGIN ((uint64_t)0xcbf29ce484222325u)

/* Returns the hash of a sequence of bytes to which `count` more bytes are appended. hash: the hash of the
 * sequence without these bytes. */
static inline uint64_t hl_hash_bytes(uint64_t hash, const void *bytes, size_t count) {
  const unsigned char *at = bytes;
  for (size_t n = 0; n < count; n++) hash = (hash ^ at[n]) * 0x100000001b3u;
  return hash;
}

#endif
