/* film/movie.h - joins pictures to a film. ffmpeg runs as a program and reads the pictures from a pipe. */
#ifndef HL_FILM_MOVIE_H
#define HL_FILM_MOVIE_H

#include <stdbool.h>
#include <stddef.h>

#include <halflight/halflight.h>

typedef struct movie movie;

/* The extensions of films that can be written. The first ending in the list is ".mp4"; null follows the last
 * ending. */
extern const char *const movie_extensions[];

/* Returns whether the program ffmpeg is in the PATH. */
bool movie_available(void);

/* Begins a film. `path` ends in one of the extensions; the file appears, complete, when movie_end() returns.
 * All functions return HL_ERROR_UNSUPPORTED if ffmpeg is absent, and HL_ERROR_IO with ffmpeg's own words if
 * it fails. SIGPIPE must be ignored. */
hl_status movie_begin(const char *path, double frames_per_second, movie **result, hl_error *error);

/* Adds a picture, which is given as the bytes of a PNG file. All pictures of a film have the same size. After
 * a failure the film m is destroyed. */
hl_status movie_add(movie *m, const unsigned char *png, size_t length, hl_error *error);

/* Two functions that end a film m. movie_end() completes the film and destroys m. movie_abandon() destroys m
 * and leaves no file behind; it accepts null. */
hl_status movie_end(movie *m, hl_error *error);
void movie_abandon(movie *m);

#endif
