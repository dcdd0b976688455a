/* film/film.h - makes films. A film is one scene in which some numbers change from frame to frame.
 *
 * A key's path names a number of the scene's file. The path consists of keys of objects and numbers of
 * elements, with points between ("volumes.0.transfer_function.opacity.2.1"). Points, directions and colours
 * can change as a whole, too ("lights.0.direction"). Four more paths move the camera as the options of
 * `halflight render` do: camera.azimuth, camera.elevation and camera.roll are in degrees, and camera.zoom is
 * a factor on the scene's own zoom. The paths lights.N.azimuth and lights.N.elevation turn a directional
 * light as `--light` does. These angles are seen from the camera, after the camera was turned. */
#ifndef HL_FILM_FILM_H
#define HL_FILM_FILM_H

#include <halflight/halflight.h>
#include <stdbool.h>

typedef struct film film;

enum { FILM_WHOLE_TURN = -1 };

typedef struct film_options {
  hl_context *context;
  const hl_scene *scene;
  const char *const *keys; /* [key_count]; the texts of the keys: "PATH=FRAME|SECONDSs:VALUE,..." */
  size_t key_count;
  double frames_per_second; /* for the keys' times in seconds */
  /* whether numbers change slowly near the two given frames between which they change; if not, they change at
   * an even pace */
  bool smooth;
  /* the number of frames in which the camera turns once about the picture's vertical axis; 0 if the camera
   * does not turn; FILM_WHOLE_TURN stands for all frames of the film */
  int turntable;
  /* number of frames of the film. If it is 0, the film has the frames of the turntable, or, without a
   * turntable, the frames up to the last frame that has a key */
  int frames;
} film_options;

/* Makes a film. Fails if keys cannot be read or no number lies at their paths (HL_ERROR_ARGUMENT), or if the
 * scene of the first or last frame is refused. The film is destroyed with film_destroy(), which accepts
 * null. */
hl_status film_create(const film_options *options, film **result, hl_error *error);
void film_destroy(film *f);

int film_frames(const film *f);

/* Makes the scene of a frame. frame: counted from 0. The scene has the volumes of the film's scene, and is
 * owned by the caller. */
hl_status film_scene(const film *f, int frame, hl_scene **scene, hl_error *error);

/* Zooms a camera about its target: at the factor 2 everything looks twice as large. In parallel projection
 * the eye stays where it is. */
void film_zoom(hl_camera *camera, double factor);

#endif
