/* cli/info/picture.h - prints the properties of a picture's file. */
#ifndef HL_CLI_INFO_PICTURE_H
#define HL_CLI_INFO_PICTURE_H

#include <jansson.h>
#include <stdbool.h>

#include "cli/host.h"
#include "cli/json_writer.h"

/* A picture's file, and the scene that lies in it. */
typedef struct info_picture {
  hl_image_about about;
  json_t *scene;        /* owned; null if the picture holds no scene */
  json_t *field_errors; /* owned; the differences between the fields of the scene's volumes and their files,
                         * as the picture states them; null if it states none */
  size_t panels;        /* the number of panels of the figure that the picture carries; 0 if there is none */
} info_picture;

/* Reads a picture's file. title: its name in messages. bytes: [length]. Returns the exit code; call
 * info_picture_release() even after a failure. */
int info_picture_read(cli_host *host, const char *title, const void *bytes, size_t length,
                      info_picture *picture);
void info_picture_release(info_picture *picture);

/* Prints the picture's size, bits, and the camera, volumes and stated differences of its scene. */
void info_picture_print(const info_picture *picture);
/* Writes the same facts as JSON: as the member "picture" of the open object. */
void info_picture_print_json(const info_picture *picture, json_writer *json);

/* Prints the difference between a volume's field and its file (hl_volume_field_error). whose: "", or the name
 * of the volume in the form "NAME: ". */
void info_print_difference(const char *whose, double value, double of_range, const char *kind,
                           const char *source);

/* Prints the properties of a picture without a scene: a PNG without one, OpenEXR or Radiance HDR. */
int info_of_plain_picture(const info_picture *picture, const char *title, bool as_json);

/* Prints the kind of a PDF or SVG file. Nothing else is read of such files. */
int info_of_page(const char *path, bool as_json);

#endif
