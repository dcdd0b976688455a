/* shadow/light_exchange.h - how renderers that share a picture tell each other what they know of its light.
 */
#ifndef HL_SHADOW_LIGHT_EXCHANGE_H
#define HL_SHADOW_LIGHT_EXCHANGE_H

#include <stddef.h>

/* The parts of one picture, each made by a renderer of its own. */
typedef struct light_exchange {
  int part, parts; /* this renderer's number; how many there are */
  /* Gives everyone the bytes of all parts: from: [bytes]; to: [parts][bytes]. All parts call it equally
   * often, and each time with as many bytes as the others. */
  void (*gather)(void *data, const void *from, size_t bytes, void *to);
  void *data; /* borrowed */
} light_exchange;

#endif
