/* analytic/light_meeting.h - renderers in threads of one process that exchange light as ranks do. */
#ifndef LIGHT_MEETING_H
#define LIGHT_MEETING_H

#include "core/light_exchange.h"
#include "reference_stage.h"

enum { MOST_BANDS = 8 }; /* the greatest number of parts of a picture */

typedef struct meeting meeting;

/* The thread of a renderer that makes a part of the picture. */
typedef struct part_thread {
  meeting *meeting;
  light_exchange exchange;
  void (*prepare)(stage *set);
  /* the number of shadow buffer pixels that this part filled, and the number of bytes that it gathered, its
   * own bytes included
   */
  uint64_t filled, gathered;
  int looks;    /* how often a part looked at messages that were still under way */
  bool spoiled; /* whether a message was changed while it was under way */
  float *pixels;
  int width, height, frames;
  hl_status status;
} part_thread;

enum { TOGETHER_SIDE = 256 };

/* How parts exchange light. WAITING: each part waits for the others. POSTING: each part goes on while
 * messages are under way. LITTLE_POSTS: each part sends messages of a few tiles. */
typedef enum exchange_way { WAITING, POSTING, LITTLE_POSTS } exchange_way;

/* Renders a picture by several parts at once. The sum of the parts' pixels is the picture. A second frame
 * uses the memory of the first. threads: [parts]. */
void render_together(part_thread *threads, int parts, exchange_way how, int width, int height, int frames,
                     void (*prepare)(stage *set), float *pixels);

#endif
