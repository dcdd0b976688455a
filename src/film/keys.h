/* film/keys.h - reads the argument of `--key PATH=FRAME:VALUE,...`, which gives values over time. */
#ifndef HL_FILM_KEYS_H
#define HL_FILM_KEYS_H

#include <halflight/halflight.h>
#include <stdbool.h>

enum { FILM_MOST_FRAMES = 1000000, FILM_MOST_POINTS = 1000 };

/* A number, or three numbers of a point, a direction or a colour, that change from frame to frame. Between
 * two given frames, the numbers change linearly, or smoothly: slowly near each of the two frames. Between
 * two keys, a direction turns the shortest way from the first key's direction to the second key's
 * direction. Values are constant before the first given frame and after the last. */
typedef struct film_key {
  /* owned; the path of the number that changes: "camera.azimuth", or keys and numbers of elements as in
   * "lights.0.intensity" */
  char *path;
  int *frames;    /* owned; [count]; frame numbers in rising order */
  double *values; /* owned; [count][components]; the values at these frames */
  size_t count;   /* number of the given frames, at least 1 */
  int components; /* 1 or 3 */
  bool is_color;  /* the values were given as colours, and are linear RGB */
  bool turns;     /* the values are directions */
  bool smooth;
} film_key;

/* Reads "PATH=FRAME:VALUE,FRAME:VALUE,...". A FRAME is the number of a frame, or a time as "1.5s", for which
 * the nearest frame is taken. A VALUE is a number, three numbers X,Y,Z, or a colour. Returns
 * HL_ERROR_ARGUMENT if the text is no key; the error names the place in the text. Call film_key_release()
 * even after a failure. */
hl_status film_key_read(const char *text, double frames_per_second, film_key *key, hl_error *error);
void film_key_release(film_key *key);

/* Finds the value of a key at a frame. value: the key's components; components that the key does not have are
 * 0. */
void film_key_value(const film_key *key, int frame, double value[3]);

#endif
