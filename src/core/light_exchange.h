/* core/light_exchange.h - how renderers that share a picture tell each other what they know of its light.
 */
#ifndef HL_CORE_LIGHT_EXCHANGE_H
#define HL_CORE_LIGHT_EXCHANGE_H

#include <stddef.h>

/* What a part gives all others, and what it gets from them, while it is under way. */
typedef struct light_post {
  const void *from; /* [bytes]; nobody changes it until it has arrived */
  size_t bytes;     /* at most `most` */
  void *to;         /* [parts][most]; what the others gave, from the start of each; nobody reads it before */
  size_t most;
  void *memory; /* [post_bytes] of the exchange, for its own use */
} light_post;

/* The parts of one picture, each made by a renderer of its own. All parts call its functions equally often,
 * and in the same order. */
typedef struct light_exchange {
  int part, parts; /* this renderer's number; how many there are */
  /* Gives everyone the bytes of all parts: from: [bytes]; to: [parts][bytes]. Each time with as many bytes as
   * the others. */
  void (*gather)(void *data, const void *from, size_t bytes, void *to);
  void *data; /* borrowed */
  /* The same while a part goes on with its work; parts may give unequally many bytes, all with the same
   * `most`. `send` begins and returns at once; `receive` waits until all has arrived; `look` lets it get on
   * meanwhile, and is called as often as a part likes. All three may be null: it is then gathered at once. */
  void (*send)(void *data, const light_post *post);
  void (*look)(void *data, const light_post *post);
  void (*receive)(void *data, const light_post *post);
  size_t post_bytes;  /* of a post's memory */
  size_t most_posted; /* bytes of the posts of all parts together, about; 0: some megabytes */
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
