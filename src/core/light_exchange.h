/* core/light_exchange.h - messages about light between renderers that share a picture. */
#ifndef HL_CORE_LIGHT_EXCHANGE_H
#define HL_CORE_LIGHT_EXCHANGE_H

#include <stddef.h>

/* The bytes that a part sends to all others and the bytes that it receives from them, while the messages are
 * under way. */
typedef struct light_post {
  const void *from; /* [bytes]; nobody may change these bytes before they have arrived */
  size_t bytes;     /* at most `most` */
  void *to;         /* [parts][most]; the bytes of part n begin at row n; nobody may read them before they
                     * have arrived */
  size_t most;
  void *memory; /* for the exchange's own use; [the exchange's post_bytes] */
} light_post;

/* The parts of one picture, each made by a renderer of its own. All parts call these functions equally often
 * and in the same order. */
typedef struct light_exchange {
  int part, parts; /* number of this renderer's part; number of parts */
  /* Sends this part's bytes to all parts, and receives theirs. Returns when all have arrived. All parts send
   * the same number of bytes. from: [bytes]; to: [parts][bytes]. */
  void (*gather)(void *data, const void *from, size_t bytes, void *to);
  void *data; /* borrowed */
  /* Exchanges bytes while a part goes on with its work. Parts may give different numbers of bytes, all with
   * the same `most`. `send` begins an exchange and returns at once. `look` lets it make progress, and may be
   * called at any time. `receive` waits until everything has arrived. All three may be null; then bytes are
   * gathered at once. */
  void (*send)(void *data, const light_post *post);
  void (*look)(void *data, const light_post *post);
  void (*receive)(void *data, const light_post *post);
  size_t post_bytes;  /* size of a post's memory */
  size_t most_posted; /* about how many bytes a post receives from all parts together; 0: some megabytes */
} light_exchange;

static inline void hl_light_send(const light_exchange *exchange, const light_post *post) {
  if (exchange->send != NULL) exchange->send(exchange->data, post);
  else exchange->gather(exchange->data, post->from, post->most, post->to);
}
static inline void hl_light_look(const light_exchange *exchange, const light_post *post) {
  if (exchange->look != NULL) exchange->look(exchange->data, post);
}
static inline void hl_light_receive(const light_exchange *exchange, const light_post *post) {
  if (exchange->receive != NULL) exchange->receive(exchange->data, post);
}

#endif
