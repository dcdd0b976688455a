/* ranks/exchange.c - see exchange.h. */
#include "ranks/exchange.h"

#include "ranks/ranks.h"

static void gather(void *data, const void *from, size_t bytes, void *to) {
  hl_ranks_gather(data, from, bytes, to);
}

static void send(void *data, const light_post *post) {
  hl_ranks_send(data, post->from, post->bytes, post->to, post->most, post->memory);
}

static void look(void *data, const light_post *post) { hl_ranks_look(data, post->memory); }

static void receive(void *data, const light_post *post) { hl_ranks_receive(data, post->memory); }

light_exchange hl_ranks_exchange(hl_ranks *ranks) {
  if (hl_ranks_size(ranks) == 1) return (light_exchange){0};
  return (light_exchange){.part = hl_ranks_rank(ranks),
                          .parts = hl_ranks_size(ranks),
                          .gather = gather,
                          .data = ranks,
                          .send = send,
                          .look = look,
                          .receive = receive,
                          .post_bytes = 2 * (size_t)hl_ranks_size(ranks) * sizeof(mpi_handle)};
}
