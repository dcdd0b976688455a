/* analytic/light_meeting.h - renderers in threads of one process that exchange light as ranks do. */
#ifndef LIGHT_MEETING_H
#define LIGHT_MEETING_H

#include "core/light_exchange.h"
#include "reference_stage.h"

enum { MOST_BANDS = 8 }; /* the most parts of a picture */

typedef struct meeting meeting;

/* A renderer of a part of the picture. */
typedef struct part_thread {
  meeting *meeting;
  light_exchange exchange;
  void (*prepare)(stage *set);
  uint64_t filled, gathered; /* pixels of the light; bytes of this part, sent ones too */
  int looks;                 /* at posts under way */
  bool spoiled;              /* a post was changed on its way */
  float *pixels;
  int width, height, frames;
  hl_status status;
} part_thread;

enum { TOGETHER_SIDE = 256 };

/* How parts exchange light: they wait for each other; they go on meanwhile; in posts of a few tiles. */
typedef enum exchange_way { WAITING, POSTING, LITTLE_POSTS } exchange_way;

/* Renders a picture by so many parts at once; its pixels are the parts' sum. A second frame finds memory that
 * the first has used. threads: [parts]. */
void render_together(part_thread *threads, int parts, exchange_way how, int width, int height, int frames,
                     void (*prepare)(stage *set), float *pixels);

#endif
