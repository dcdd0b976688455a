/* volume/file_space.c - see file_space.h. */
#include "volume/file_space.h"

#include "core/context.h"
#include "text/body_axes.h"

/* The meaning of three letters. */
typedef struct meaning {
  hl_space space; /* the space of the world after it was turned */
  int axis[3];    /* for x, y and z of the file: the axis of the turned world along which it lies */
  double sign[3]; /* for x, y and z of the file: 1 if it points along this axis, -1 if against it */
} meaning;

/* Reads three letters. A world whose axes are those of a space that has a name is not turned. */
static bool read_letters(const char *text, meaning *letters) {
  static const double ahead[][2] = {
      [HL_SPACE_RAS] = {1, 1}, [HL_SPACE_LPS] = {-1, -1}, [HL_SPACE_LAS] = {-1, 1}};
  *letters = (meaning){.space = HL_SPACE_RAS};
  if (!hl_body_axes_read(text, letters->axis, letters->sign)) return false;
  const bool in_order = letters->axis[0] == 0 && letters->axis[1] == 1 && letters->sign[2] > 0;
  for (int space = HL_SPACE_RAS; in_order && space <= HL_SPACE_LAS; space++)
    if (letters->sign[0] == ahead[space][0] && letters->sign[1] == ahead[space][1]) {
      letters->space = (hl_space)space;
      letters->sign[0] = letters->sign[1] = 1;
      break;
    }
  return true;
}

/* Returns whether the letters let the axes of the world point along the turned world's axes. */
static bool is_unturned(const meaning *letters) {
  for (int n = 0; n < 3; n++)
    if (letters->axis[n] != n || letters->sign[n] < 0) return false;
  return true;
}

/* A vector times 1 or -1. Subtracting from zero avoids -0. */
static vec3 signed_row(double sign, vec3 row) {
  const vec3 zero = {0, 0, 0};
  return sign > 0 ? row : vec3_subtract(zero, row);
}

/* Turns the world of a volume, so that x, y and z of its file lie along the axes that the letters name. */
static void turn(const meaning *letters, hl_volume *volume) {
  if (volume == NULL) return;
  affine3 *place = &volume->index_to_world;
  const affine3 old = *place;
  const double offset[3] = {old.offset.x, old.offset.y, old.offset.z};
  double turned[3] = {0};
  for (int n = 0; n < 3; n++) {
    place->linear.row[letters->axis[n]] = signed_row(letters->sign[n], old.linear.row[n]);
    turned[letters->axis[n]] = letters->sign[n] > 0 ? offset[n] : 0 - offset[n];
  }
  place->offset = (vec3){turned[0], turned[1], turned[2]};
}

void hl_volume_state_space(hl_context *context, const char *path, const char *text, hl_volume *volume) {
  meaning letters;
  if (text == NULL || !read_letters(text, &letters)) return;
  if (volume->space != HL_SPACE_UNKNOWN && !(volume->space == letters.space && is_unturned(&letters)))
    hl_log(context, HL_LOG_WARNING,
           "%s: its file says that its axes are %s: they are read as %s, as --space states", path,
           hl_space_name(volume->space), text);
  turn(&letters, volume);
  turn(&letters, volume->continued);
  turn(&letters, volume->wall);
  volume->space = letters.space;
  volume->is_anatomical = true;
}

void hl_volume_turn_into(hl_context *context, const char *path, hl_space wanted, hl_volume *volume) {
  static const double signs[][2] = {
      [HL_SPACE_RAS] = {1, 1}, [HL_SPACE_LPS] = {-1, -1}, [HL_SPACE_LAS] = {-1, 1}};
  if (wanted == HL_SPACE_UNKNOWN || volume->space == HL_SPACE_UNKNOWN || volume->space == wanted) return;
  affine3 *place = &volume->index_to_world;
  if (signs[wanted][0] != signs[volume->space][0]) {
    place->linear.row[0] = signed_row(-1, place->linear.row[0]);
    place->offset.x = 0 - place->offset.x;
  }
  if (signs[wanted][1] != signs[volume->space][1]) {
    place->linear.row[1] = signed_row(-1, place->linear.row[1]);
    place->offset.y = 0 - place->offset.y;
  }
  hl_log(context, HL_LOG_WARNING, "%s: its world is %s: it is turned into %s, that of the volumes before it",
         path, hl_space_name(volume->space), hl_space_name(wanted));
  volume->space = wanted;
}
