/* tests/unit/volume_sparse.c - pages of volumes in which most voxels have one value. */
#include <stdlib.h>
#include <string.h>

#include "core/context.h"
#include "small_volume.h"
#include "volume/io/destination.h"
#include "volume/store/pages.h"

/* the way in which clang tells that there is a sanitizer */
#if defined(__has_feature) && !defined(__SANITIZE_ADDRESS__)
#if __has_feature(address_sanitizer)
#define __SANITIZE_ADDRESS__
#endif
#endif

enum { SHIFT = 2, MOST = 23 * 19 * 17 };

/* A pseudo-random number below `below`. */
static size_t next(uint32_t *seed, size_t below) {
  *seed = *seed * 1664525u + 1013904223u;
  return (*seed >> 8) % below;
}

typedef struct stored {
  size_t n[3], bytes;
  unsigned char value[4];         /* the value of voxels that are not stored */
  unsigned char voxels[MOST * 4]; /* the voxels that the pages should hold */
  bool known[MOST];               /* whether a voxel was stored */
} stored;

/* Stores a box of numbers in the pages and in the expected voxels, unless any of its voxels was stored. */
static void store_box(hl_pages *pages, stored *s, const size_t begin[3], const size_t count[3],
                      uint32_t *seed) {
  static unsigned char box[MOST * 4];
  size_t at = 0;
  for (size_t k = 0; k < count[2]; k++)
    for (size_t j = 0; j < count[1]; j++)
      for (size_t i = 0; i < count[0]; i++)
        if (s->known[((begin[2] + k) * s->n[1] + begin[1] + j) * s->n[0] + begin[0] + i]) return;
  for (size_t k = 0; k < count[2]; k++)
    for (size_t j = 0; j < count[1]; j++)
      for (size_t i = 0; i < count[0]; i++, at += s->bytes) {
        const size_t voxel = ((begin[2] + k) * s->n[1] + begin[1] + j) * s->n[0] + begin[0] + i;
        for (size_t b = 0; b < s->bytes; b++) box[at + b] = (unsigned char)(next(seed, 63) + 1);
        memcpy(s->voxels + voxel * s->bytes, box + at, s->bytes);
        s->known[voxel] = true;
      }
  hl_pages_store_box(pages, begin, count, box);
}

static void check_rows(const hl_pages *pages, const stored *s) {
  unsigned char row[23 * 4];
  for (size_t k = 0; k < s->n[2]; k++)
    for (size_t j = 0; j < s->n[1]; j++) {
      const size_t first = (k * s->n[1] + j) * s->n[0];
      hl_pages_load_row(pages, j, k, row);
      assert_memory_equal(row, s->voxels + first * s->bytes, s->n[0] * s->bytes);
      for (size_t i = 0; i < s->n[0]; i++)
        assert_true(hl_page_number(pages, i, j, k) ==
                    hl_stored_number(pages->storage, s->voxels + first * s->bytes, i));
    }
}

/* Boxes are stored at random. The pages hold them, and the one value elsewhere. If a run of voxels is
 * reported to have one value, it has. */
static void test_boxes(void **state) {
  (void)state;
  static const hl_voxel_type types[] = {HL_VOXEL_U8, HL_VOXEL_U16, HL_VOXEL_F32};
  static stored s;
  hl_context *context = make_context();
  for (uint32_t trial = 0; trial < 30; trial++) {
    uint32_t seed = trial;
    const size_t size[3] = {1 + next(&seed, 23), 1 + next(&seed, 19), 1 + next(&seed, 17)};
    hl_volume_description grid;
    hl_pages *pages;
    hl_volume_description_defaults(&grid);
    grid.type = types[trial % 3];
    memcpy(grid.dimensions, size, sizeof size);
    memset(&s, 0, sizeof s);
    memcpy(s.n, size, sizeof size);
    s.bytes = hl_storage_bytes(hl_voxel_type_storage(grid.type));
    for (size_t b = 0; b < s.bytes; b++) s.value[b] = trial % 2 == 0 ? 0 : (unsigned char)(65 + b);
    const size_t voxels = size[0] * size[1] * size[2];
    for (size_t v = 0; v < voxels; v++) memcpy(s.voxels + v * s.bytes, s.value, s.bytes);
    assert_int_equal(hl_pages_create_sparse(context, &grid, SHIFT, s.value, &pages, NULL), HL_OK);
    assert_true(hl_pages_have_one_value(pages, 0, voxels));
    for (int boxes = 0; boxes < 12; boxes++) {
      size_t begin[3], count[3];
      for (int a = 0; a < 3; a++)
        begin[a] = next(&seed, size[a]), count[a] = 1 + next(&seed, size[a] - begin[a]);
      for (int a = 0; a < 3; a++) count[a] = count[a] > 5 ? 5 : count[a];
      store_box(pages, &s, begin, count, &seed);
      check_rows(pages, &s);
      const size_t first = next(&seed, voxels), run = 1 + next(&seed, voxels - first);
      for (size_t v = first; hl_pages_have_one_value(pages, first, run) && v < first + run; v++)
        assert_false(s.known[v]);
    }
    hl_pages_release(pages);
    assert_int_equal(atomic_load(&context->paged), 0);
  }
  hl_context_destroy(context);
}

/* Memory is taken only for the pages of stored voxels, and not for voxels of the one value. */
static void test_memory(void **state) {
  (void)state;
  static const uint16_t one = 7, same[] = {9, 9}, other[] = {9, 8};
  hl_context *context = make_context();
  hl_volume_description grid;
  hl_pages *pages;
  hl_volume_description_defaults(&grid);
  grid.type = HL_VOXEL_U16;
  grid.dimensions[0] = grid.dimensions[1] = grid.dimensions[2] = 2048;
  assert_int_equal(hl_pages_create_sparse(context, &grid, PAGE_SHIFT, &same, &pages, NULL), HL_OK);
  const uint64_t page = pages->page_bytes;
  assert_int_equal(atomic_load(&context->paged), page);
  hl_pages_store_box(pages, (const size_t[3]){100, 100, 100}, (const size_t[3]){2, 1, 1}, same);
  assert_int_equal(atomic_load(&context->paged), page);
  hl_pages_store_box(pages, (const size_t[3]){100, 100, 100}, (const size_t[3]){2, 1, 1}, other);
  assert_int_equal(atomic_load(&context->paged), 2 * page);
  hl_pages_store_box(pages, (const size_t[3]){64, 128, 1000}, (const size_t[3]){1, 1, 1}, &one);
  assert_int_equal(atomic_load(&context->paged),
                   6 * page); /* where pages overlap along x and y, four hold it */
  assert_true(hl_page_number(pages, 64, 128, 1000) == 7 && hl_page_number(pages, 65, 128, 1000) == 9);
  assert_true(hl_page_number(pages, 101, 100, 100) == 8 && hl_page_number(pages, 2047, 2047, 2047) == 9);
  hl_pages_release(pages);
  hl_context_destroy(context);
}

/* If voxels fill more than a quarter of the pages, they are moved into one array. */
static void test_crowded(void **state) {
  (void)state;
  hl_context *context = make_context();
  hl_volume_description grid;
  hl_destination to;
  const uint8_t value = 3;
  uint8_t *box = malloc(256 * 256 * 64);
  hl_volume_description_defaults(&grid);
  grid.dimensions[0] = grid.dimensions[1] = grid.dimensions[2] = 256;
  assert_int_equal(hl_destination_open_sparse(context, &grid, &value, "a file", &to, NULL), HL_OK);
  assert_true(hl_destination_is_sparse(&to) && !hl_destination_is_crowded(&to));
  for (size_t n = 0; n < 256 * 256 * 64; n++) box[n] = (uint8_t)(n % 251);
  hl_pages_store_box(to.pages, (const size_t[3]){0, 0, 128}, (const size_t[3]){256, 256, 64}, box);
  assert_true(hl_destination_is_crowded(&to));
  assert_int_equal(hl_destination_spread(&to, NULL), HL_OK);
  assert_false(hl_destination_is_sparse(&to));
  for (size_t n = 0; n < 256 * 256 * 256; n++) {
    const size_t within = n - 256 * 256 * 128;
    assert_int_equal(to.voxels[n], n >= 256 * 256 * 128 && within < 256 * 256 * 64 ? within % 251 : value);
  }
  hl_destination_close(&to);
  free(box);
  hl_context_destroy(context);
}

#ifndef __SANITIZE_ADDRESS__ /* the address sanitizer ends a program that asks for more than 1 TiB */
/* Without a limit, a volume gets no sparse pages if the machine's memory has no room for all of them, however
 * few voxels a file has. */
static void test_beyond_memory(void **state) {
  (void)state;
  hl_context *context = make_context();
  hl_volume_description grid;
  hl_destination to;
  const uint8_t value = 0;
  hl_volume_description_defaults(&grid);
  grid.dimensions[0] = grid.dimensions[1] = grid.dimensions[2] = (size_t)1 << 14; /* 4 TiB */
  (void)hl_destination_open_sparse(context, &grid, &value, "a file", &to, NULL);
  assert_false(hl_destination_is_sparse(&to));
  hl_destination_close(&to);
  hl_context_destroy(context);
}
#endif

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_boxes),
      cmocka_unit_test(test_memory),
      cmocka_unit_test(test_crowded),
#ifndef __SANITIZE_ADDRESS__
      cmocka_unit_test(test_beyond_memory),
#endif
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
