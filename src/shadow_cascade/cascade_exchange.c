/* shadow_cascade/cascade_exchange.c - the parts of a shared picture tell each other what their light
 * absorbed.
 *
 * A part attenuates the tiles that it needs. Penumbrae bring it the shadows of matter in other tiles, which
 * others attenuate: after each chunk the owner of each tile that the chunk has touched sends what the groups
 * at the chunk's ends hold there. So every part's groups are complete, the same as in one renderer, and each
 * blurs them where its own tiles read them. Messages are gathered a fixed number at a time: their memory does
 * not grow with the tiles. */
#include <string.h>

#include "shadow_cascade/cascade_passes.h"

/* What is gathered at a time takes about so many bytes. */
enum { GATHERED_BYTES = 8 << 20 };

/* The fields of a channel that a chunk changes: absorbed and thin, of the group at its start and at its end.
 */
enum { MESSAGE_FIELDS = 4 };

/* The head of a message. After it: [channels][MESSAGE_FIELDS][TILE_PIXELS] pixels. */
typedef struct message_head {
  uint32_t tile;
  uint32_t filled; /* bits: the fields that are not all zeros, in their order */
} message_head;

void hl_cascade_exchange_lay_out(soft_cascade *cascade, const light_exchange *with, shadow_layouts *layouts) {
  cascade_exchange *exchange = &cascade->exchange;
  const cascade_level *level = &cascade->level[0];
  exchange->with = with;
  if (with == NULL) return;
  size_t parts = (size_t)with->parts, most = (size_t)level->tiles_x * (size_t)level->tiles_y;
  exchange->slot_bytes = sizeof(message_head) +
                         (size_t)cascade->channels * MESSAGE_FIELDS * TILE_PIXELS * sizeof(field_pixel);
  exchange->slots = GATHERED_BYTES / (parts * exchange->slot_bytes) + 1;
  if (exchange->slots > most) exchange->slots = most;
  exchange->outgoing = hl_layout_take(&layouts->passing, exchange->slots, exchange->slot_bytes);
  exchange->incoming = hl_layout_take(&layouts->passing, parts * exchange->slots, exchange->slot_bytes);
  exchange->counts = hl_layout_take(&layouts->passing, parts, sizeof *exchange->counts);
}

static const cascade_field *field_of(const cascade_group *start, const cascade_group *end, int channel,
                                     int field) {
  const cascade_group *group = field < 2 ? start : end;
  return field % 2 == 0 ? &group->absorbed[channel] : &group->thin[channel];
}

/* One tile's pixels, from a field to a message or back. */
static void pack_tile(const cascade_level *level, const cascade_field *field, size_t tile, field_pixel *to) {
  const field_pixel *from = field->pixels + tile / (size_t)level->tiles_x * TILE * level->stride +
                            tile % (size_t)level->tiles_x * TILE;
  for (size_t row = 0; row < TILE; row++)
    memcpy(to + row * TILE, from + row * level->stride, TILE * sizeof *to);
}

static void unpack_tile(const cascade_level *level, const cascade_field *field, size_t tile,
                        const field_pixel *from) {
  field_pixel *to = field->pixels + tile / (size_t)level->tiles_x * TILE * level->stride +
                    tile % (size_t)level->tiles_x * TILE;
  for (size_t row = 0; row < TILE; row++)
    memcpy(to + row * level->stride, from + row * TILE, TILE * sizeof *to);
  field->zeros[tile] = 0;
}

/* One chunk's exchange. */
typedef struct chunk_exchange {
  soft_cascade *cascade;
  const unsigned char *owned;
  const cascade_group *start, *end;
} chunk_exchange;

static void write_message(const chunk_exchange *chunk, size_t tile, unsigned char *message) {
  const soft_cascade *cascade = chunk->cascade;
  message_head head = {.tile = (uint32_t)tile};
  field_pixel *pixels = (field_pixel *)(void *)(message + sizeof head);
  for (int i = 0; i < cascade->channels * MESSAGE_FIELDS; i++) {
    const cascade_field *field = field_of(chunk->start, chunk->end, i / MESSAGE_FIELDS, i % MESSAGE_FIELDS);
    if (field->zeros[tile]) continue;
    head.filled |= 1u << i;
    pack_tile(&cascade->level[0], field, tile, pixels + (size_t)i * TILE_PIXELS);
  }
  memcpy(message, &head, sizeof head);
}

static void read_message(const chunk_exchange *chunk, const unsigned char *message) {
  const soft_cascade *cascade = chunk->cascade;
  const cascade_level *level = &cascade->level[0];
  message_head head;
  memcpy(&head, message, sizeof head);
  const field_pixel *pixels = (const field_pixel *)(const void *)(message + sizeof head);
  int x = (int)(head.tile % (uint32_t)level->tiles_x), y = (int)(head.tile / (uint32_t)level->tiles_x);
  for (int i = 0; i < cascade->channels * MESSAGE_FIELDS; i++) {
    const cascade_field *field = field_of(chunk->start, chunk->end, i / MESSAGE_FIELDS, i % MESSAGE_FIELDS);
    if (head.filled >> i & 1) unpack_tile(level, field, head.tile, pixels + (size_t)i * TILE_PIXELS);
    else hl_cascade_clear_tile(level, field, x, y);
  }
}

static bool is_sent(const chunk_exchange *chunk, size_t tile) {
  return chunk->owned[tile] && chunk->cascade->touched[tile];
}

/* Writes the next messages, from tile *tile on. */
static void write_messages(const chunk_exchange *chunk, size_t tiles, size_t *tile) {
  const cascade_exchange *exchange = &chunk->cascade->exchange;
  for (size_t slot = 0; slot < exchange->slots && *tile < tiles; (*tile)++)
    if (is_sent(chunk, *tile))
      write_message(chunk, *tile, exchange->outgoing + slot++ * exchange->slot_bytes);
}

static void read_messages(const chunk_exchange *chunk, size_t done, size_t slots) {
  const cascade_exchange *exchange = &chunk->cascade->exchange;
  for (int part = 0; part < exchange->with->parts; part++)
    for (size_t slot = 0; slot < slots && done + slot < exchange->counts[part]; slot++)
      if (part != exchange->with->part)
        read_message(chunk, exchange->incoming + ((size_t)part * slots + slot) * exchange->slot_bytes);
}

bool hl_cascade_exchange_chunk(soft_cascade *cascade, const unsigned char *owned, cascade_group *start,
                               cascade_group *end) {
  const cascade_exchange *exchange = &cascade->exchange;
  const light_exchange *with = exchange->with;
  const chunk_exchange chunk = {cascade, owned, start, end};
  size_t tiles = (size_t)cascade->level[0].tiles_x * (size_t)cascade->level[0].tiles_y, tile = 0, most = 0;
  uint32_t own = 0;
  for (size_t i = 0; i < tiles; i++) own += is_sent(&chunk, i);
  with->gather(with->data, &own, sizeof own, exchange->counts);
  for (int part = 0; part < with->parts; part++)
    if (exchange->counts[part] > most) most = exchange->counts[part];
  for (size_t done = 0; done < most; done += exchange->slots) {
    size_t slots = most - done < exchange->slots ? most - done : exchange->slots;
    write_messages(&chunk, tiles, &tile);
    with->gather(with->data, exchange->outgoing, slots * exchange->slot_bytes, exchange->incoming);
    read_messages(&chunk, done, slots);
  }
  return most > 0;
}
