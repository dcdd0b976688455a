/* volume/convert.c - converts packed voxels to stored form.
 *
 * In: bytes as a file or a caller gives them. Out: voxels of type u8, u16 or f32 in native byte order. Each
 * type has a loop of its own, which compilers vectorise. Values are loaded by memcpy, because bytes from
 * files are not aligned. */
#include "volume/convert.h"

#include <string.h>

static const struct {
  const char *name;
  unsigned char bytes;
  hl_storage storage;
  double bias;
} types[] = {
    [HL_VOXEL_U8] = {"uint8", 1, HL_STORAGE_U8, 0},     [HL_VOXEL_I8] = {"int8", 1, HL_STORAGE_U8, 128},
    [HL_VOXEL_U16] = {"uint16", 2, HL_STORAGE_U16, 0},  [HL_VOXEL_I16] = {"int16", 2, HL_STORAGE_U16, 32768},
    [HL_VOXEL_U32] = {"uint32", 4, HL_STORAGE_F32, 0},  [HL_VOXEL_I32] = {"int32", 4, HL_STORAGE_F32, 0},
    [HL_VOXEL_F32] = {"float32", 4, HL_STORAGE_F32, 0}, [HL_VOXEL_F64] = {"float64", 8, HL_STORAGE_F32, 0},
    [HL_VOXEL_U64] = {"uint64", 8, HL_STORAGE_F32, 0},  [HL_VOXEL_I64] = {"int64", 8, HL_STORAGE_F32, 0},
    [HL_VOXEL_F16] = {"float16", 2, HL_STORAGE_F32, 0},
};

static bool known(hl_voxel_type type) { return (int)type >= HL_VOXEL_U8 && (int)type <= HL_VOXEL_F16; }

const char *hl_voxel_type_name(hl_voxel_type type) { return known(type) ? types[type].name : "unknown"; }
size_t hl_voxel_type_bytes(hl_voxel_type type) { return known(type) ? types[type].bytes : 0; }
hl_storage hl_voxel_type_storage(hl_voxel_type type) { return types[type].storage; }
double hl_voxel_type_bias(hl_voxel_type type) { return types[type].bias; }

static void store_8(uint8_t flip, const unsigned char *source, size_t count, unsigned char *destination) {
  if (flip == 0) {
    if (source != destination) memcpy(destination, source, count);
    return;
  }
  for (size_t n = 0; n < count; n++) destination[n] = source[n] ^ flip;
}

static void store_16(uint16_t flip, bool swap, const unsigned char *source, size_t count,
                     unsigned char *destination) {
  if (!swap && flip == 0) {
    if (source != destination) memcpy(destination, source, 2 * count);
    return;
  }
  for (size_t n = 0; n < count; n++) {
    uint16_t value;
    memcpy(&value, source + 2 * n, 2);
    if (swap) value = (uint16_t)(value << 8 | value >> 8);
    value ^= flip;
    memcpy(destination + 2 * n, &value, 2);
  }
}

static uint32_t load_32(const unsigned char *source, bool swap) {
  uint32_t value;
  memcpy(&value, source, 4);
  return swap ? __builtin_bswap32(value) : value;
}

static void store_u32(bool swap, const unsigned char *source, size_t count, unsigned char *destination) {
  for (size_t n = 0; n < count; n++) {
    float value = (float)load_32(source + 4 * n, swap);
    memcpy(destination + 4 * n, &value, 4);
  }
}

static void store_i32(bool swap, const unsigned char *source, size_t count, unsigned char *destination) {
  for (size_t n = 0; n < count; n++) {
    float value = (float)(int32_t)load_32(source + 4 * n, swap);
    memcpy(destination + 4 * n, &value, 4);
  }
}

static void store_f32(bool swap, const unsigned char *source, size_t count, unsigned char *destination) {
  if (!swap) {
    if (source != destination) memcpy(destination, source, 4 * count);
    return;
  }
  for (size_t n = 0; n < count; n++) {
    uint32_t value = load_32(source + 4 * n, true);
    memcpy(destination + 4 * n, &value, 4);
  }
}

static uint64_t load_64(const unsigned char *source, bool swap) {
  uint64_t value;
  memcpy(&value, source, 8);
  return swap ? __builtin_bswap64(value) : value;
}

static void store_u64(bool swap, const unsigned char *source, size_t count, unsigned char *destination) {
  for (size_t n = 0; n < count; n++) {
    float value = (float)load_64(source + 8 * n, swap);
    memcpy(destination + 4 * n, &value, 4);
  }
}

static void store_i64(bool swap, const unsigned char *source, size_t count, unsigned char *destination) {
  for (size_t n = 0; n < count; n++) {
    float value = (float)(int64_t)load_64(source + 8 * n, swap);
    memcpy(destination + 4 * n, &value, 4);
  }
}

static void store_f64(bool swap, const unsigned char *source, size_t count, unsigned char *destination) {
  for (size_t n = 0; n < count; n++) {
    uint64_t bits = load_64(source + 8 * n, swap);
    double wide;
    memcpy(&wide, &bits, 8);
    float value = (float)wide;
    memcpy(destination + 4 * n, &value, 4);
  }
}

/* Converts an IEEE 754 binary16 number, which has a sign bit, five bits of exponent (bias 15) and ten bits of
 * fraction. */
static float half_to_float(uint16_t half) {
  uint32_t sign = (uint32_t)(half & 0x8000) << 16, exponent = half >> 10 & 31, fraction = half & 0x3ff, bits;
  if (exponent == 0) {
    float value = (float)fraction * 0x1p-24f; /* the value of a subnormal number is fraction / 2^10 times
                                               * 2^-14 */
    return sign != 0 ? -value : value;
  }
  bits = sign | (exponent == 31 ? 255 : exponent + 112) << 23 | fraction << 13;
  float value;
  memcpy(&value, &bits, 4);
  return value;
}

static void store_f16(bool swap, const unsigned char *source, size_t count, unsigned char *destination) {
  for (size_t n = 0; n < count; n++) {
    uint16_t half;
    memcpy(&half, source + 2 * n, 2);
    float value = half_to_float(swap ? (uint16_t)(half << 8 | half >> 8) : half);
    memcpy(destination + 4 * n, &value, 4);
  }
}

void hl_voxels_store(hl_voxel_type type, bool swap, const void *source, size_t count, void *destination) {
  switch (type) {
    case HL_VOXEL_U8: store_8(0, source, count, destination); break;
    case HL_VOXEL_I8: store_8(0x80, source, count, destination); break;
    case HL_VOXEL_U16: store_16(0, swap, source, count, destination); break;
    case HL_VOXEL_I16: store_16(0x8000, swap, source, count, destination); break;
    case HL_VOXEL_U32: store_u32(swap, source, count, destination); break;
    case HL_VOXEL_I32: store_i32(swap, source, count, destination); break;
    case HL_VOXEL_F32: store_f32(swap, source, count, destination); break;
    case HL_VOXEL_F64: store_f64(swap, source, count, destination); break;
    case HL_VOXEL_U64: store_u64(swap, source, count, destination); break;
    case HL_VOXEL_I64: store_i64(swap, source, count, destination); break;
    case HL_VOXEL_F16: store_f16(swap, source, count, destination); break;
  }
}

void hl_voxels_gather(const unsigned char *source, ptrdiff_t stride_bytes, size_t voxel_bytes, size_t count,
                      unsigned char *row) {
  switch (voxel_bytes) {
    case 1:
      for (size_t i = 0; i < count; i++) row[i] = source[(ptrdiff_t)i * stride_bytes];
      break;
    case 2:
      for (size_t i = 0; i < count; i++) memcpy(row + 2 * i, source + (ptrdiff_t)i * stride_bytes, 2);
      break;
    case 4:
      for (size_t i = 0; i < count; i++) memcpy(row + 4 * i, source + (ptrdiff_t)i * stride_bytes, 4);
      break;
    default:
      for (size_t i = 0; i < count; i++) memcpy(row + 8 * i, source + (ptrdiff_t)i * stride_bytes, 8);
      break;
  }
}
