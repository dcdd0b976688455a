/* compose/color_by.c - applies the option "color-by" FILE[:MAP[:LO,HI]]: the volumes keep their opacities,
 * and get the colours of the values that another volume has at the same place. The other volume joins the
 * scene, and is not visible. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "compose/color_by.h"
#include "compose/looks.h"
#include "core/context.h"
#include "core/file.h"
#include "core/memory.h"
#include "scene/function/function_plane.h"
#include "scene/function/transfer_function.h"
#include "scene/geometry/lengths.h"
#include "scene/geometry/placement.h"
#include "text/plain.h"
#include "text/stem.h"
#include "volume/load_beside.h"

enum { NAME_BYTES = 64 };

static const char *const colormap_of_fields = "viridis";

/* The value of the option in its parts. */
typedef struct typed_coloring {
  char *file; /* owned */
  const char *map;
  double range[2]; /* [0] < [1] if a range was typed */
} typed_coloring;

/* Takes the last part after ':' off a text, if the part is a range LO,HI. */
static void take_range(char *text, double range[2]) {
  char *colon = strrchr(text, ':'), *rest;
  if (colon == NULL) return;
  const double low = hl_plain_number(colon + 1, &rest);
  if (rest == colon + 1 || *rest != ',') return;
  char *second = rest + 1;
  const double high = hl_plain_number(second, &rest);
  if (rest == second || *rest != '\0' || !isfinite(low) || !isfinite(high)) return;
  range[0] = low, range[1] = high;
  *colon = '\0';
}

/* Takes the last part after ':' off the file's name, if the part is the name of a colormap. If only the name
 * before this part is that of a file, the part was meant for a colormap, and is refused. */
static hl_status take_map(const hl_composer *composer, typed_coloring *typed) {
  char *colon = strrchr(typed->file, ':');
  typed->map = colormap_of_fields;
  if (colon == NULL) return HL_OK;
  const char *map = hl_find_colormap(colon + 1);
  if (map == NULL && hl_file_kind(composer->context, typed->file) != 0) return HL_OK;
  *colon = '\0';
  if (map != NULL) typed->map = map;
  else if (hl_file_kind(composer->context, typed->file) != 0)
    return hl_refuse_colormap("color-by", colon + 1, composer->error);
  else *colon = ':';
  return HL_OK;
}

/* Reads the option's value. typed->file is owned by the caller, also after a failure. */
static hl_status read_coloring(const hl_composer *composer, const char *text, typed_coloring *typed) {
  *typed = (typed_coloring){.file = hl_copy_text(composer->context, text)};
  if (typed->file == NULL) return hl_fail_memory(composer->error, strlen(text) + 1, "a name");
  take_range(typed->file, typed->range);
  if (typed->range[0] > typed->range[1])
    return hl_fail(composer->error, HL_ERROR_ARGUMENT, "--color-by: '%.200s': LO must be below HI", text);
  return take_map(composer, typed);
}

/* Refuses scenes whose matter cannot have the colours of another volume. */
static hl_status check_scene(const hl_composer *composer, const hl_scene_description *description) {
  size_t colored = 0;
  if (hl_is_maximum(composer, description))
    return hl_fail(composer->error, HL_ERROR_ARGUMENT,
                   "--color-by: a maximum projection shows one volume's values: give another look, as --look "
                   "surface");
  for (size_t v = 0; v < description->volume_count; v++) {
    const hl_scene_volume *volume = &description->volumes[v];
    colored += volume->label_count == 0;
    if (volume->iso_count > 0)
      return hl_fail(composer->error, HL_ERROR_ARGUMENT,
                     "--color-by colours matter, and an isosurface has one colour: in place of --iso give "
                     "--threshold %.9g",
                     volume->iso[0].value);
  }
  if (colored == 0)
    return hl_fail(composer->error, HL_ERROR_ARGUMENT,
                   "--color-by is for volumes of values: the picture has none");
  return HL_OK;
}

/* Loads the other volume into *made. typed: keeps the text of the file's name. name: [NAME_BYTES]. */
static hl_status load(const hl_composer *composer, const hl_scene_description *description,
                      const typed_coloring *typed, char *name, hl_scene_volume *made) {
  const hl_scene_volume *first = &description->volumes[0];
  hl_volume_load_options reading;
  hl_volume_load_options_defaults(&reading);
  reading.space = first->volume->space;
  hl_scene_volume_defaults(made);
  hl_status status = hl_volume_load_beside(composer->context, typed->file, first->volume, first->spacing,
                                           &reading, &made->volume, composer->error);
  if (status != HL_OK) return hl_blame_options(status);
  size_t length;
  const char *stem = hl_stem(typed->file, &length);
  snprintf(name, NAME_BYTES, "%.*s", (int)fmin((double)length, NAME_BYTES - 1), stem);
  if (hl_scene_volume_named(description, name) != NULL) snprintf(name, NAME_BYTES, "color-by");
  made->file = typed->file;
  made->scale = hl_scene_file_scale(description, made->volume);
  made->name = name;
  made->visible = 0;
  memcpy(made->spacing, reading.spacing, sizeof made->spacing);
  return HL_OK;
}

/* Gives a volume its own opacities, and the colours of the other volume's values. */
static void color_by(const hl_scene_volume *other, const hl_transfer_function *colors,
                     hl_scene_volume *volume) {
  hl_transfer_function *function = &volume->transfer_function;
  function->plane = (hl_function_plane){.second = HL_SECOND_VOLUME,
                                        .volume = other->name,
                                        .curves = {.opacity = function->opacity,
                                                   .opacity_count = function->opacity_count,
                                                   .color = colors->color,
                                                   .color_count = colors->color_count}};
}

hl_status hl_compose_color_by(const hl_composer *composer, hl_scene_description *description,
                              hl_coloring *made) {
  const hl_asked *asked = &composer->asked[HL_ASK_COLOR_BY];
  const size_t count = description->volume_count;
  typed_coloring typed;
  *made = (hl_coloring){0};
  if (!asked->given) return HL_OK;
  hl_status status = check_scene(composer, description);
  if (status != HL_OK) return status;
  status = read_coloring(composer, asked->text, &typed);
  made->file = typed.file;
  if (status != HL_OK) return status;
  made->volumes = hl_allocate(composer->context, count + 1, sizeof *made->volumes);
  if (made->volumes == NULL)
    return hl_fail_memory(composer->error, (count + 1) * sizeof *made->volumes, "the scene's volumes");
  memcpy(made->volumes, description->volumes, count * sizeof *made->volumes);
  hl_scene_volume *other = &made->volumes[count];
  status = load(composer, description, &typed, made->name, other);
  if (status != HL_OK) return status;
  made->other = other->volume;
  double range[2] = {other->volume->minimum, other->volume->maximum};
  if (typed.range[0] < typed.range[1]) memcpy(range, typed.range, sizeof range);
  if (!(range[0] < range[1])) range[1] = nextafter(range[0], INFINITY);
  status = hl_transfer_function_colormap(composer->context, typed.map, range[0], range[1], &made->colors,
                                         composer->error);
  for (size_t v = 0; v < count && status == HL_OK; v++)
    if (made->volumes[v].label_count == 0 && !hl_has_plane(&made->volumes[v].transfer_function))
      color_by(other, &made->colors, &made->volumes[v]);
  description->volumes = made->volumes;
  description->volume_count = count + 1;
  return status;
}

void hl_coloring_release(hl_context *context, hl_coloring *made) {
  hl_transfer_function_release(context, &made->colors);
  hl_volume_release(made->other);
  hl_release(context, made->volumes);
  hl_release(context, made->file);
}
