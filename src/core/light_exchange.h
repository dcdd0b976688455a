/* core/light_exchange.h - declares the messages about light between renderers that share a picture. */
#ifndef HL_CORE_LIGHT_EXCHANGE_H
#define HL_CORE_LIGHT_EXCHANGE_H

#include <stddef.h>

/* A post: the bytes that a part sends to all other parts, and the bytes that it receives from them, while the
 * exchange is in progress. */
typedef struct light_post {
  const void *from; /* [bytes]; the bytes of this part, which must not be changed before the exchange has
                     * ended */
  size_t bytes;     /* number of bytes of this part; at most `most` */
  /* [parts][most]; receives the bytes of all parts; row n gets the bytes of part n; must not be read before
   * the exchange has ended */
  void *to;
  size_t most;
  void *memory; /* memory for the exchange itself; [the exchange's post_bytes] */
} light_post;

/* The exchange of messages among renderers each of which makes a part of one picture. All parts call the
 * functions of the exchange equally often and in the same order. */
typedef struct light_exchange {
  int part, parts; /* part: number of this renderer's part; parts: number of parts */
  /* Sends this part's bytes to all parts, and receives the bytes of all parts. Returns when the bytes of all
   * parts have arrived. All parts send the same number of bytes. from: [bytes]; to: [parts][bytes]. */
  void (*gather)(void *data, const void *from, size_t bytes, void *to);
  void *data; /* the first argument of the functions; borrowed */
  /* send(), look() and receive() exchange bytes while a part goes on with its work. Parts may send different
   * numbers of bytes, but the posts of all parts have the same `most`. `send` begins an exchange and returns
   * at once. `look` lets the exchange make progress, and may be called at any time. `receive` waits until the
   * bytes of all parts have arrived. The three functions may be null; `gather` is then called in place of
   * `send`. */
  void (*send)(void *data, const light_post *post);
  void (*look)(void *data, const light_post *post);
  void (*receive)(void *data, const light_post *post);
  size_t post_bytes; /* number of bytes of a post's `memory` */
  /* the approximate number of bytes that a post should receive from all parts together; 0 stands for a
   * default of a few megabytes */
  size_t most_posted;
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
