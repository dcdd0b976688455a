/* cli/info/picture.h - what the file of a picture says of itself. */
#ifndef HL_CLI_INFO_PICTURE_H
#define HL_CLI_INFO_PICTURE_H

#include <jansson.h>
#include <stdbool.h>

#include "cli/host.h"
#include "cli/json_writer.h"

/* A picture's file, and the scene that lies in it. */
typedef struct info_picture {
  hl_image_about about;
  json_t *scene;        /* owned; null: the picture holds no scene */
  json_t *field_errors; /* owned; how far the fields of the scene's volumes are from their files, as the
                         * picture states it; null: it states nothing */
} info_picture;

/* Reads a picture's file. title: its name in messages. bytes: [length]. Returns the exit code; call
 * info_picture_release() even after a failure. */
int info_picture_read(cli_host *host, const char *title, const void *bytes, size_t length,
                      info_picture *picture);
void info_picture_release(info_picture *picture);

/* Prints the picture's size, bits, and the camera, volumes and stated differences of its scene. */
void info_picture_print(const info_picture *picture);
/* The same as one member "picture" of the object that is open. */
void info_picture_print_json(const info_picture *picture, json_writer *json);

/* Prints how far a volume's field is from what its file says (hl_volume_field_error). whose: "", or the
 * volume that the line is of, as "NAME: ". */
void info_print_difference(const char *whose, double value, double of_range, const char *kind,
                           const char *source);

/* `halflight info` for a picture that holds no scene: a PNG without one, OpenEXR and Radiance HDR. */
int info_of_plain_picture(const info_picture *picture, const char *title, bool as_json);

/* `halflight info` for PDF and SVG, of which nothing is read. */
int info_of_page(const char *path, bool as_json);

#endif
