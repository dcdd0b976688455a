/* film/movie.h - joins pictures to a film: ffmpeg, run as a program, reads them from a pipe. */
#ifndef HL_FILM_MOVIE_H
#define HL_FILM_MOVIE_H

#include <stdbool.h>
#include <stddef.h>

#include <halflight/halflight.h>

typedef struct movie movie;

/* The extensions of films that can be written, ".mp4" first; null after the last. */
extern const char *const movie_extensions[];

/* Whether ffmpeg is in the PATH. */
bool movie_available(void);

/* Begins a film. `path` ends in one of the extensions; the file is complete when movie_end() has returned,
 * and never there as a half. All calls return HL_ERROR_UNSUPPORTED if ffmpeg is absent, and HL_ERROR_IO with
 * ffmpeg's own words if it fails. SIGPIPE must be ignored. */
hl_status movie_begin(const char *path, double frames_per_second, movie **result, hl_error *error);

/* Adds a picture, as the bytes of a PNG; all pictures of a film have the same size. After a failure m is
 * destroyed. */
hl_status movie_add(movie *m, const unsigned char *png, size_t length, hl_error *error);

/* Ends the film; m is destroyed. movie_abandon() leaves nothing behind; null is allowed. */
hl_status movie_end(movie *m, hl_error *error);
void movie_abandon(movie *m);

#endif
