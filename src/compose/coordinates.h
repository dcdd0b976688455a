/* compose/coordinates.h - reads places in a volume from text: fractions of the volume's box, or coordinates
 * of the world of the volume's file. */
#ifndef HL_COMPOSE_COORDINATES_H
#define HL_COMPOSE_COORDINATES_H

#include <halflight/volume.h>
#include <stdbool.h>

/* A coordinate as it was typed. A bare number is a fraction of the box around the volume's voxels. A number
 * with a unit is a coordinate of the file's world. */
typedef struct hl_coordinate {
  bool given, fraction;
  double number;
  double metres; /* the length of the number's unit; 0 if the number is in the file's own unit */
} hl_coordinate;

/* Reads a coordinate such as "0.25", "10mm" or "10u" from the beginning of a text, and moves *text past the
 * coordinate. An empty coordinate is read, too. The unit "u" stands for the file's own unit. Returns false if
 * the text begins with something else. */
bool hl_read_coordinate(const char **text, hl_coordinate *coordinate);

/* A box in a world, and the world's unit. */
typedef struct hl_world_box {
  double low[3], high[3];
  const char *unit; /* a name of the unit of lengths; null if the unit is not known */
} hl_world_box;

/* The box around a volume's voxels in the world of its file. given: the unit that the option "unit" names;
 * null if the option is not given, so that the file tells the unit. Returns false if the volume's place is
 * not known. */
bool hl_world_box_of(const hl_volume *volume, const char *given, hl_world_box *box);

/* Writes where a box lies, as "the volume goes from 0,0,0 to 1,1,1 m". what: the name of the thing in the
 * box. If the unit is not known, the text names the option that sets it. */
enum { HL_BOX_TEXT = 240 };
const char *hl_describe_box(const hl_world_box *box, const char *what, char text[HL_BOX_TEXT]);

/* The length of a unit of a box's world in metres; 0 if the unit is not known, or is no length. */
double hl_metres_of_box(const hl_world_box *box);

/* Converts a number with a unit to the unit of the file's world. metres: the length of the world's unit, as
 * hl_metres_of_box() gives it. If metres is 0, the number is taken to be in the world's unit already. */
double hl_length_of(const hl_coordinate *coordinate, double metres);

/* The coordinate in the file's world. otherwise: the result if the text has no number. low, high: the ends of
 * the box around the volume's voxels. metres: as for hl_length_of(). */
double hl_coordinate_of(const hl_coordinate *coordinate, double otherwise, double low, double high,
                        double metres);

/* Reads a range along an axis, as "x=LO:HI", from the beginning of a text, and moves *text past the range.
 * Returns false if the text begins with something else. */
typedef struct hl_axis_range {
  int axis;
  hl_coordinate ends[2];
} hl_axis_range;
bool hl_read_range(const char **text, hl_axis_range *range);

/* Reads a box: ranges along axes, each axis at most once, joined by commas, as "x=0.5:,z=:40mm"; or three
 * ranges without axes, for x, y and z. A range that is not given has no ends. Returns false if the text is
 * something else. */
bool hl_read_box(const char *text, hl_axis_range box[3]);

/* Returns whether a range has an end. */
bool hl_range_is_given(const hl_axis_range *range);

/* Refuses a value of an option that names a side of a body, as "left=0:0.5", where ranges along axes are
 * wanted. Returns HL_OK for other texts. */
hl_status hl_refuse_side(const char *option, const char *text, hl_error *error);

#endif
