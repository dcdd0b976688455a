/* splat/bounds_lanes.h - elementwise bounds of many rows, as plain loops that compilers turn into vectors. */
#ifndef HL_SPLAT_BOUNDS_LANES_H
#define HL_SPLAT_BOUNDS_LANES_H

#include <stddef.h>
#include <stdint.h>

enum { BOUND_CHUNK = 256 };

static void bound_rows_u8(const void *const *rows, int row_count, size_t count, float *least,
                          float *greatest) {
  for (size_t start = 0; start < count; start += BOUND_CHUNK) {
    uint8_t low[BOUND_CHUNK], high[BOUND_CHUNK];
    size_t length = count - start < BOUND_CHUNK ? count - start : BOUND_CHUNK;
    for (size_t i = 0; i < length; i++) low[i] = high[i] = ((const uint8_t *)rows[0])[start + i];
    for (int r = 1; r < row_count; r++) {
      const uint8_t *row = (const uint8_t *)rows[r] + start;
      for (size_t i = 0; i < length; i++) low[i] = row[i] < low[i] ? row[i] : low[i];
      for (size_t i = 0; i < length; i++) high[i] = row[i] > high[i] ? row[i] : high[i];
    }
    for (size_t i = 0; i < length; i++) least[start + i] = low[i], greatest[start + i] = high[i];
  }
}

static void bound_rows_u16(const void *const *rows, int row_count, size_t count, float *least,
                           float *greatest) {
  for (size_t start = 0; start < count; start += BOUND_CHUNK) {
    uint16_t low[BOUND_CHUNK], high[BOUND_CHUNK];
    size_t length = count - start < BOUND_CHUNK ? count - start : BOUND_CHUNK;
    for (size_t i = 0; i < length; i++) low[i] = high[i] = ((const uint16_t *)rows[0])[start + i];
    for (int r = 1; r < row_count; r++) {
      const uint16_t *row = (const uint16_t *)rows[r] + start;
      for (size_t i = 0; i < length; i++) low[i] = row[i] < low[i] ? row[i] : low[i];
      for (size_t i = 0; i < length; i++) high[i] = row[i] > high[i] ? row[i] : high[i];
    }
    for (size_t i = 0; i < length; i++) least[start + i] = low[i], greatest[start + i] = high[i];
  }
}

static void bound_rows_f32(const void *const *rows, int row_count, size_t count, float *least,
                           float *greatest) {
  for (size_t i = 0; i < count; i++) least[i] = greatest[i] = ((const float *)rows[0])[i];
  for (int r = 1; r < row_count; r++) {
    const float *row = rows[r];
    for (size_t i = 0; i < count; i++) least[i] = row[i] < least[i] ? row[i] : least[i];
    for (size_t i = 0; i < count; i++) greatest[i] = row[i] > greatest[i] ? row[i] : greatest[i];
  }
}

#endif
