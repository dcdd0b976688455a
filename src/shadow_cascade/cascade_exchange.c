/* shadow_cascade/cascade_exchange.c - exchanges the light that slabs have absorbed, between the parts of a
 * shared picture.
 *
 * A part attenuates the tiles that it needs. Penumbrae reach into these tiles from matter in other tiles,
 * which other parts attenuate. So after each chunk, for each tile that the chunk has touched, the tile's
 * owner sends this tile's pixels of the two groups at the chunk's ends. Every part then has the complete
 * groups that a single renderer of the whole picture would have. Each part blurs the groups where its own
 * tiles read them.
 *
 * The groups of a chunk are first read at the end of the next chunk (Near matter, cascade.h). So the messages
 * of a chunk are under way while all parts work on the next chunk, and a part waits only for parts that are
 * more than a chunk behind. Messages are sent in posts, each of a limited number of messages, so that their
 * memory does not grow with the number of tiles. The first post is sent at the chunk's end. If a part has
 * further posts, it sends each of them when the post before it has been received. */
#include <string.h>

#include "shadow_cascade/cascade_passes.h"

/* The approximate number of bytes of the posts of all parts together, if the exchange does not set a
 * number. */
enum { MOST_POSTED = 8 << 20 };

/* The head of a post. */
typedef struct post_head {
  uint32_t count;  /* number of this part's messages in all posts of the chunk */
  uint32_t unused; /* padding, so that messages begin at a multiple of 8 bytes */
} post_head;

/* The fields of a channel that a chunk changes: `absorbed` and `thin`, of the group at the chunk's start and
 * of the group at its end. */
enum { MESSAGE_FIELDS = 4 };

/* The head of a message about one tile. The tile's pixels follow the head:
 * [channels][MESSAGE_FIELDS][TILE_PIXELS]. */
typedef struct message_head {
  uint32_t tile;
  uint32_t filled; /* one bit for each field, in the order of the fields: 0 where the field is all zeros */
} message_head;

void hl_cascade_exchange_lay_out(soft_cascade *cascade, const light_exchange *with, shadow_layouts *layouts) {
  cascade_exchange *exchange = &cascade->exchange;
  const cascade_level *level = &cascade->level[0];
  exchange->with = with;
  if (with == NULL) return;
  size_t parts = (size_t)with->parts, tiles = (size_t)level->tiles_x * (size_t)level->tiles_y;
  exchange->slot_bytes = sizeof(message_head) +
                         (size_t)cascade->channels * MESSAGE_FIELDS * TILE_PIXELS * sizeof(field_pixel);
  size_t bytes = with->most_posted > 0 ? with->most_posted : MOST_POSTED;
  exchange->slots = bytes / (parts * exchange->slot_bytes) + 1;
  if (exchange->slots > tiles) exchange->slots = tiles;
  light_post *post = &exchange->post;
  post->most = sizeof(post_head) + exchange->slots * exchange->slot_bytes;
  exchange->outgoing = hl_layout_take(&layouts->passing, post->most, 1);
  post->to = exchange->incoming = hl_layout_take(&layouts->passing, parts, post->most);
  post->memory = hl_layout_take(&layouts->passing, with->post_bytes, 1);
  exchange->sends = hl_layout_take(&layouts->passing, tiles, 1);
  post->from = exchange->outgoing;
}

static const cascade_field *field_of(const cascade_group *start, const cascade_group *end, int channel,
                                     int field) {
  const cascade_group *group = field < 2 ? start : end;
  return field % 2 == 0 ? &group->absorbed[channel] : &group->thin[channel];
}

/* pack_tile() copies the pixels of one tile from a field to a message, and unpack_tile() copies the pixels
 * from a message to a field. */
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

/* The groups whose pixels are exchanged after a chunk. */
typedef struct chunk_exchange {
  soft_cascade *cascade;
  cascade_group *start, *end;
} chunk_exchange;

/* The two groups at the ends of the chunk that ended last. */
static chunk_exchange last_chunk(soft_cascade *cascade) {
  cascade_level *level = &cascade->level[0];
  return (chunk_exchange){cascade, &level->group[level->count - 2], &level->group[level->count - 1]};
}

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

/* Sends the next messages about the chunk's tiles, up to the number that a post holds. */
static void send_messages(const chunk_exchange *chunk) {
  cascade_exchange *exchange = &chunk->cascade->exchange;
  const cascade_level *level = &chunk->cascade->level[0];
  size_t tiles = (size_t)level->tiles_x * (size_t)level->tiles_y, slot = 0;
  unsigned char *to = exchange->outgoing + sizeof(post_head);
  memcpy(exchange->outgoing, &(post_head){.count = exchange->count}, sizeof(post_head));
  for (; slot < exchange->slots && exchange->tile < tiles; exchange->tile++)
    if (exchange->sends[exchange->tile])
      write_message(chunk, exchange->tile, to + slot++ * exchange->slot_bytes);
  exchange->post.bytes = sizeof(post_head) + slot * exchange->slot_bytes;
  hl_light_send(exchange->with, &exchange->post);
}

static size_t count_of(const cascade_exchange *exchange, int part) {
  post_head head = {.count = exchange->count};
  if (part != exchange->with->part)
    memcpy(&head, exchange->incoming + (size_t)part * exchange->post.most, sizeof head);
  return head.count;
}

/* Stores the received messages. done: number of messages of each part that were stored before. */
static void read_messages(const chunk_exchange *chunk, size_t done) {
  const cascade_exchange *exchange = &chunk->cascade->exchange;
  for (int part = 0; part < exchange->with->parts; part++) {
    const unsigned char *from = exchange->incoming + (size_t)part * exchange->post.most + sizeof(post_head);
    size_t count = count_of(exchange, part);
    for (size_t slot = 0; slot < exchange->slots && done + slot < count; slot++)
      if (part != exchange->with->part) read_message(chunk, from + slot * exchange->slot_bytes);
  }
}

void hl_cascade_exchange_send(soft_cascade *cascade, const unsigned char *owned) {
  cascade_exchange *exchange = &cascade->exchange;
  const chunk_exchange chunk = last_chunk(cascade);
  size_t tiles = (size_t)cascade->level[0].tiles_x * (size_t)cascade->level[0].tiles_y;
  exchange->tile = exchange->count = 0;
  for (size_t i = 0; i < tiles; i++) {
    exchange->sends[i] = owned[i] && cascade->touched[i];
    exchange->count += exchange->sends[i];
  }
  exchange->sent = true;
  send_messages(&chunk);
}

void hl_cascade_exchange_look(const soft_cascade *cascade) {
  const cascade_exchange *exchange = &cascade->exchange;
  if (exchange->sent) hl_light_look(exchange->with, &exchange->post);
}

void hl_cascade_exchange_receive(soft_cascade *cascade) {
  cascade_exchange *exchange = &cascade->exchange;
  if (!exchange->sent) return;
  const chunk_exchange chunk = last_chunk(cascade);
  size_t most = 0;
  hl_light_receive(exchange->with, &exchange->post);
  for (int part = 0; part < exchange->with->parts; part++)
    if (count_of(exchange, part) > most) most = count_of(exchange, part);
  read_messages(&chunk, 0);
  for (size_t done = exchange->slots; done < most; done += exchange->slots) {
    send_messages(&chunk);
    hl_light_receive(exchange->with, &exchange->post);
    read_messages(&chunk, done);
  }
  exchange->sent = false;
  chunk.end->filled = most > 0;
  chunk.start->filled = chunk.start->filled || most > 0;
}
