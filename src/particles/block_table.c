/* particles/block_table.c - implements a hash table of blocks (block_table.h). The table uses open
 * addressing: a block whose entry is taken by another block goes to the next free entry. */
#include "particles/block_table.h"

#include <string.h>

#include "core/memory.h"

enum { LEAST_SIZE = 64 };

/* The entry of a block in the table: the entry that holds the block's number, or the free entry where the
 * number would be put. */
static size_t entry_of(const hl_block_table *table, const int32_t place[3]) {
  uint64_t hash = (uint32_t)place[0] * 0x9e3779b97f4a7c15u + (uint32_t)place[1] * 0xbf58476d1ce4e5b9u +
                  (uint32_t)place[2] * 0x94d049bb133111ebu;
  hash ^= hash >> 29;
  hash *= 0xbf58476d1ce4e5b9u;
  for (size_t entry = (hash >> 32) & (table->size - 1);; entry = (entry + 1) & (table->size - 1)) {
    uint32_t number = table->entries[entry];
    if (number == 0 || memcmp(table->place[number - 1], place, sizeof table->place[0]) == 0) return entry;
  }
}

ptrdiff_t hl_block_number(const hl_block_table *table, const int32_t place[3]) {
  return table->size > 0 ? (ptrdiff_t)table->entries[entry_of(table, place)] - 1 : -1;
}

static bool double_entries(hl_context *context, hl_block_table *table) {
  size_t size = table->size > 0 ? 2 * table->size : LEAST_SIZE;
  uint32_t *entries = hl_allocate_zeroed(context, size, sizeof *entries);
  if (entries == NULL) return false;
  hl_release(context, table->entries);
  table->entries = entries;
  table->size = size;
  for (size_t n = 0; n < table->count; n++)
    table->entries[entry_of(table, table->place[n])] = (uint32_t)(n + 1);
  return true;
}

static bool double_places(hl_context *context, hl_block_table *table) {
  size_t room = 2 * table->room + LEAST_SIZE / 2;
  int32_t(*place)[3] = hl_reallocate(context, table->place, room, sizeof *place);
  if (place == NULL) return false;
  table->place = place;
  table->room = room;
  return true;
}

hl_status hl_block_add(hl_context *context, hl_block_table *table, const int32_t place[3],
                       const char *subject, size_t *number, hl_error *error) {
  if ((2 * (table->count + 1) > table->size && !double_entries(context, table)) ||
      (table->count == table->room && !double_places(context, table)) || table->count >= INT32_MAX)
    return hl_fail_memory(error, 2 * table->size * sizeof *table->entries, subject);
  uint32_t *entry = &table->entries[entry_of(table, place)];
  if (*entry == 0) {
    memcpy(table->place[table->count], place, sizeof table->place[0]);
    *entry = (uint32_t)++table->count;
  }
  if (number != NULL) *number = *entry - 1;
  return HL_OK;
}

void hl_block_table_release(hl_context *context, hl_block_table *table) {
  hl_release(context, table->entries);
  hl_release(context, table->place);
  *table = (hl_block_table){.count = 0};
}
