/* figure/bar.c - draws the scale bar, which shows the length of a line in the world.
 *
 * The bar's unit is the unit that the volumes' files tell, or else the unit that the overlay names. If both
 * are missing, the bar is refused. After the scales that the scene gives them, the lengths of all visible
 * volumes whose files tell a unit must be in one unit. A volume whose file tells no unit, such as a mask over
 * a scan, is taken to be in the unit of the others. In a perspective picture the scale changes with depth.
 * The bar's length is then right at one depth only, which the overlay chooses and the bar's text names. */
#include <stdio.h>
#include <string.h>

#include "figure/overlay.h"
#include "text/plain.h"
#include "text/units.h"

enum { LABEL_BYTES = 96 };

/* The unit of the scene's lengths. */
typedef struct bar_unit {
  const char *name;    /* the unit's name in the files */
  const hl_unit *unit; /* the unit; null if its name is not known */
  double per_scene;    /* the length of one unit of the scene's world, in the files' unit */
} bar_unit;

static const char *name_of(const hl_scene_volume *volume) {
  return volume->name != NULL ? volume->name : volume->file != NULL ? volume->file : "volume";
}

/* Fails because the lengths of two volumes have different units in the scene's world. */
static hl_status refuse_units(const hl_scene_volume *volume, const bar_unit *own, const bar_unit *before,
                              hl_error *error) {
  const bool same = strcmp(own->name, before->name) == 0;
  char mend[64] = "another \"scale\"";
  if (own->unit != NULL && before->unit != NULL)
    hl_plain_print(mend, sizeof mend, "the \"scale\" %.6g",
                   hl_length_ratio(own->unit->metres, before->unit->metres * before->per_scene));
  return hl_fail(
      error, HL_ERROR_ARGUMENT,
      "scale bar: the lengths of '%.60s' are in %.20s%s, and those of the volumes before in %.20s: "
      "give its \"transform\" in the scene %s",
      name_of(volume), own->name, same ? " of another scale" : "", before->name, mend);
}

/* Returns whether two units of the scene's lengths are the same length. */
static bool are_equal(const bar_unit *a, const bar_unit *b) {
  const bool known = a->unit != NULL && b->unit != NULL;
  const double ratio = a->per_scene / b->per_scene * (known ? a->unit->metres / b->unit->metres : 1);
  return (known || strcmp(a->name, b->name) == 0) && fabs(ratio - 1) <= 1e-9;
}

/* Takes the unit of the first volume that has one, and refuses a volume whose lengths are in another unit. */
static hl_status add_volume(const hl_scene_volume *volume, const char *name, bar_unit *unit,
                            hl_error *error) {
  const double *axes = volume->axis_scale;
  if (axes[0] != axes[1] || axes[0] != axes[2])
    return hl_fail(error, HL_ERROR_ARGUMENT,
                   "scale bar: the scene stretches '%.60s' along its axes: no one scale is left",
                   name_of(volume));
  const bar_unit own = {name, hl_unit_find(name), 1 / fabs(volume->scale * axes[0])};
  if (unit->name == NULL) *unit = own;
  return are_equal(unit, &own) ? HL_OK : refuse_units(volume, &own, unit, error);
}

/* Finds the unit that the files of the visible volumes tell, or that the overlay states for them. */
static hl_status find_unit(const hl_overlay_place *place, bar_unit *unit, hl_error *error) {
  const char *world_unit = place->overlay->world_unit;
  const hl_scene_volume *silent = NULL; /* a visible volume without a unit */
  bar_unit stated = {0};                /* the unit of volumes whose files state none */
  hl_status status = HL_OK;
  for (size_t v = 0; status == HL_OK && v < place->scene->volume_count; v++) {
    const hl_scene_volume *volume = &place->scene->volumes[v];
    const char *told = hl_volume_unit(volume->volume);
    if (!volume->visible) continue;
    if (told != NULL) status = add_volume(volume, told, unit, error);
    else if (world_unit != NULL) status = add_volume(volume, world_unit, &stated, error);
    else silent = volume;
  }
  if (status != HL_OK || (unit->name != NULL && world_unit == NULL)) return status;
  if (silent != NULL)
    return hl_fail(
        error, HL_ERROR_ARGUMENT,
        "scale bar: the file of '%.60s' does not tell the unit of its lengths: say it, as --unit mm",
        name_of(silent));
  if (world_unit == NULL)
    return hl_fail(error, HL_ERROR_ARGUMENT,
                   "scale bar: no volume tells the unit of lengths: say it, as --unit mm");
  const double per_scene = unit->name != NULL ? unit->per_scene : stated.name != NULL ? stated.per_scene : 1;
  *unit = (bar_unit){world_unit, hl_unit_find(world_unit), per_scene};
  return HL_OK;
}

static hl_status find_scale(const hl_overlay_place *place, double *scale, hl_error *error) {
  double depth = place->overlay->scale_bar_depth;
  if (depth == HL_DEPTH_OF_TARGET) depth = place->map.target_depth;
  if (place->map.perspective && !(depth > 0))
    return hl_fail(
        error, HL_ERROR_ARGUMENT,
        "scale bar: a perspective picture has a scale for each depth: use --ortho, or say where the bar "
        "holds, as --scale-bar auto@target");
  *scale = hl_map_scale(&place->map, depth);
  return HL_OK;
}

/* Finds the length of the unit in which the bar's text is written, measured in the files' unit. */
static hl_status length_of(const hl_unit *written, const bar_unit *unit, double *length, hl_error *error) {
  if (written == unit->unit) *length = 1;
  else if (unit->unit != NULL) *length = written->metres / unit->unit->metres;
  else
    return hl_fail(error, HL_ERROR_ARGUMENT, "scale bar: '%.20s' is no unit that '%.20s' can be turned into",
                   unit->name, written->symbol);
  return HL_OK;
}

/* Chooses the bar's length, measured in the files' unit, and writes the bar's text. */
static hl_status choose_length(const hl_overlay *overlay, const bar_unit *unit, double longest,
                               double *length, char label[LABEL_BYTES], hl_error *error) {
  const hl_unit *written = unit->unit;
  /* the length of the unit in which the bar's text is written, measured in the files' unit */
  double in_files = 1;
  hl_status status = HL_OK;
  const char *name = overlay->scale_bar_unit;
  if (name != NULL) {
    written = hl_unit_find(name);
    if (written == NULL && strcmp(name, unit->name) != 0)
      return hl_fail(error, HL_ERROR_ARGUMENT,
                     "scale bar: '%.20s' is no unit of length: give m, cm, mm, um, nm or A", name);
  } else if (unit->unit != NULL && overlay->scale_bar_length <= 0) {
    double number = hl_round_length(longest);
    if (number < 1 || number >= 1000) written = hl_unit_for(number * unit->unit->metres);
  }
  if (written != NULL) status = length_of(written, unit, &in_files, error);
  if (status != HL_OK) return status;
  double number = overlay->scale_bar_length > 0 ? overlay->scale_bar_length
                                                : hl_round_length(longest / in_files);
  *length = number * in_files;
  hl_plain_print(label, LABEL_BYTES, "%.4g %.40s", number, written != NULL ? written->symbol : unit->name);
  return HL_OK;
}

hl_status hl_overlay_bar(const hl_ink *ink, const hl_overlay_place *place, hl_error *error) {
  bar_unit unit = {0};
  double scale = 0, length = 0;
  char label[LABEL_BYTES];
  hl_status status = find_unit(place, &unit, error);
  if (status == HL_OK) status = find_scale(place, &scale, error);
  double file_unit = scale / unit.per_scene; /* length on the page of one of the files' units, points */
  if (status == HL_OK)
    status = choose_length(place->overlay, &unit, place->picture.width / 4 / file_unit, &length, label,
                           error);
  if (status != HL_OK) return status;
  double width = length * file_unit, room = place->picture.width - 2 * place->margin;
  if (!(width <= room))
    return hl_fail(error, HL_ERROR_ARGUMENT,
                   "scale bar: %s is longer than the picture is wide: give a shorter length", label);
  const double thick = 0.22 * ink->size, left = place->picture.left + place->margin;
  const double bottom = place->picture.top + place->picture.height - place->margin;
  if (place->map.perspective && place->overlay->scale_bar_depth == HL_DEPTH_OF_TARGET)
    strncat(label, " at the target", LABEL_BYTES - strlen(label) - 1);
  else if (place->map.perspective) {
    size_t used = strlen(label);
    hl_plain_print(label + used, LABEL_BYTES - used, " at depth %.4g", place->overlay->scale_bar_depth);
  }
  hl_ink_bar(ink, (hl_rectangle){left, bottom - thick, width, thick});
  double wide, high;
  hl_line_of_text line = {.text = label, .y = bottom - 1.6 * thick, .align_y = 1, .wide_most = room};
  hl_ink_measure(ink, &(hl_line_of_text){.text = label}, &wide, &high);
  bool centred = wide <= width;
  line.x = centred ? left + (width - wide) / 2 : left;
  hl_ink_text(ink, &line);
  return HL_OK;
}
