/* scene/check/volume.c - checks a volume of a scene: its transfer function, placement and values. */
#include <math.h>
#include <stdio.h>

#include "core/vector.h"
#include "label/mask.h"
#include "scene/check/check.h"
#include "scene/function/function_plane.h"
#include "scene/geometry/placement.h"
#include "scene/label/label_table.h"

/* Checks that points are sorted by value. At most two points may have the same value; two such points make a
 * step. */
static hl_status check_order(const hl_checker *check, const char *key, size_t index, double before2,
                             double before, double value) {
  if (value < before)
    return hl_fail(check->error, HL_ERROR_INPUT,
                   "%s/%s/%zu/0: %.9g comes after %.9g: sort the points by value", check->place, key, index,
                   value, before);
  if (index >= 2 && value == before && before == before2)
    return hl_fail(
        check->error, HL_ERROR_INPUT,
        "%s/%s/%zu/0: %.9g is there a third time: two points at one value make a step, remove the others",
        check->place, key, index, value);
  return HL_OK;
}

static hl_status check_value(const hl_checker *check, const char *key, size_t index, double value) {
  char element[64];
  snprintf(element, sizeof element, "%s/%zu/0", key, index);
  return hl_check_range(check, element, value, -1e30, 1e30, "give a data value between -1e30 and 1e30");
}

static hl_status check_opacity_points(const hl_checker *check, const char *key,
                                      const hl_opacity_point *points, size_t count) {
  hl_status status = hl_check_count(check, key, points, count, HL_LIMIT_POINTS);
  for (size_t p = 0; status == HL_OK && p < count; p++) {
    const hl_opacity_point *point = &points[p];
    if ((status = check_value(check, key, p, point->value)) != HL_OK) return status;
    if (p > 0)
      status = check_order(check, key, p, p > 1 ? point[-2].value : 0, point[-1].value, point->value);
    if (status == HL_OK) status = hl_check_point_opacity(check, key, p, point->opacity);
  }
  return status;
}

static hl_status check_color_points(const hl_checker *check, const hl_transfer_function *function) {
  hl_status status = hl_check_count(check, "color", function->color, function->color_count, HL_LIMIT_POINTS);
  for (size_t p = 0; status == HL_OK && p < function->color_count; p++) {
    const hl_color_point *point = &function->color[p];
    if ((status = check_value(check, "color", p, point->value)) != HL_OK) return status;
    if (p > 0)
      status = check_order(check, "color", p, p > 1 ? point[-2].value : 0, point[-1].value, point->value);
    if (status == HL_OK) status = hl_check_point_color(check, "color", p, point->color);
  }
  return status;
}

hl_status hl_transfer_function_check(const hl_transfer_function *function, const char *place,
                                     hl_error *error) {
  hl_checker check = {error, ""};
  snprintf(check.place, sizeof check.place, "%s", place);
  hl_status status = hl_check_settings(&check, HL_SETTINGS_TRANSFER_FUNCTION, function, 0);
  if (status == HL_OK)
    status = check_opacity_points(&check, "opacity", function->opacity, function->opacity_count);
  if (status == HL_OK)
    status = check_opacity_points(&check, "gradient_opacity", function->gradient_opacity,
                                  function->gradient_opacity_count);
  if (status == HL_OK) status = check_color_points(&check, function);
  return status == HL_OK ? hl_plane_check(&function->plane, place, error) : status;
}

/* Checks the three scale factors of a volume. Each factor is the product of `scale` and one number of
 * axis_scale; errors tell the product. */
static hl_status check_axis_scales(const hl_checker *check, const hl_scene_volume *volume) {
  const double *axis = volume->axis_scale;
  if (axis[0] == 1 && axis[1] == 1 && axis[2] == 1) return HL_OK;
  for (int a = 0; a < 3; a++) {
    double scale = hl_scene_volume_scale(volume, a);
    if (scale > 0 && scale <= HL_LIMIT_LENGTH) continue;
    return hl_fail(check->error, HL_ERROR_INPUT, "%s/transform/scale/%d: %.9g %s: give a factor above 0",
                   check->place, a, scale,
                   isnan(scale) ? "is not a number"
                   : scale <= 0 ? "is not above 0"
                                : "is out of range");
  }
  return HL_OK;
}

static hl_status check_transform(const hl_checker *check, const hl_scene_volume *volume) {
  hl_status status = hl_check_key(check, HL_SETTINGS_VOLUME, "transform/scale", volume);
  if (status == HL_OK) status = check_axis_scales(check, volume);
  if (status == HL_OK && volume->rotate_angle_deg != 0)
    status = hl_check_key(check, HL_SETTINGS_VOLUME, "transform/rotate/axis", volume);
  if (status == HL_OK) status = hl_check_key(check, HL_SETTINGS_VOLUME, "transform/rotate/angle_deg", volume);
  return status == HL_OK ? hl_check_key(check, HL_SETTINGS_VOLUME, "transform/translate", volume) : status;
}

static hl_status check_clip(const hl_checker *check, const hl_scene_volume *volume) {
  if (!volume->clipped) return HL_OK;
  hl_status status = hl_check_key(check, HL_SETTINGS_VOLUME, "clip/min", volume);
  if (status == HL_OK) status = hl_check_key(check, HL_SETTINGS_VOLUME, "clip/max", volume);
  for (int a = 0; a < 3 && status == HL_OK; a++)
    if (volume->clip_min[a] >= volume->clip_max[a])
      return hl_fail(check->error, HL_ERROR_INPUT,
                     "%s/clip/max/%d: %.9g is not above min, %.9g: nothing would be left, enlarge the box",
                     check->place, a, volume->clip_max[a], volume->clip_min[a]);
  return status;
}

static hl_status check_cut(const hl_cut *cut, const char *place, hl_error *error) {
  hl_status status = hl_settings_check_key(HL_SETTINGS_CUT, "type", cut, place, error);
  if (status == HL_OK) status = hl_settings_check(HL_SETTINGS_CUT, cut, (int)cut->type, place, error);
  for (int a = 0; a < 3 && status == HL_OK && cut->type == HL_CUT_BOX; a++)
    if (cut->min[a] >= cut->max[a])
      return hl_fail(error, HL_ERROR_INPUT,
                     "%s/max/%d: %.9g is not above min, %.9g: the box is empty, enlarge it", place, a,
                     cut->max[a], cut->min[a]);
  return status;
}

hl_status hl_cuts_check(const hl_checker *check, const hl_cut *cuts, size_t count) {
  hl_status status = hl_check_count(check, "cuts", cuts, count, HL_LIMIT_CUTS);
  for (size_t i = 0; i < count && status == HL_OK; i++) {
    char place[120];
    snprintf(place, sizeof place, "%s/cuts/%zu", check->place, i);
    status = check_cut(&cuts[i], place, check->error);
  }
  return status;
}

static hl_status check_cuts(const hl_checker *check, const hl_scene_volume *volume) {
  hl_status status = hl_check_key(check, HL_SETTINGS_VOLUME, "cut_shading", volume);
  if (status == HL_OK) status = hl_check_key(check, HL_SETTINGS_VOLUME, "cut_casts_shadow", volume);
  return status == HL_OK ? hl_cuts_check(check, volume->cuts, volume->cut_count) : status;
}

static double farthest_corner(const hl_scene_volume *volume, affine3 placement) {
  double farthest = 0;
  for (int corner = 0; corner < 8; corner++) {
    vec3 index;
    index.x = corner & 1 ? (double)volume->volume->dimension[0] : 0;
    index.y = corner & 2 ? (double)volume->volume->dimension[1] : 0;
    index.z = corner & 4 ? (double)volume->volume->dimension[2] : 0;
    farthest = fmax(farthest, vec3_length(affine3_apply(placement, index)));
  }
  return farthest;
}

/* checks the placement as a whole, because the product of factors may be zero or infinite although each
 * factor is possible */
static hl_status check_placement(const hl_checker *check, const hl_scene_volume *volume) {
  affine3 placement = hl_scene_volume_index_to_world(volume), inverse;
  for (int a = 0; a < 3; a++) {
    double edge = vec3_length(mat3_column(placement.linear, a));
    if (edge <= HL_LIMIT_LENGTH && edge >= 1 / HL_LIMIT_LENGTH) continue;
    const double *by_axis = volume->axis_scale;
    if (volume->scale != 1 || by_axis[0] != 1 || by_axis[1] != 1 || by_axis[2] != 1)
      return hl_fail(check->error, HL_ERROR_INPUT,
                     "%s/transform: makes the edges of voxels %.9g long: give a scale with which they are "
                     "from 1e-15 to 1e15",
                     check->place, edge);
    return hl_fail(check->error, HL_ERROR_INPUT,
                   "%s/file: its voxels are %.9g long, and can be from 1e-15 to 1e15: correct the "
                   "file's spacing (--spacing), or give a transform.scale",
                   check->place, edge);
  }
  if (!(vec3_length(placement.offset) <= 1e3 * HL_LIMIT_LENGTH))
    return hl_check_refuse(check, "transform",
                           "moves the volume too far away to compute with: use a shorter translate");
  double reach = farthest_corner(volume, placement);
  if (!(reach <= HL_LIMIT_CORNER))
    return hl_fail(check->error, HL_ERROR_INPUT,
                   "%s/file: reaches %.3g from the origin, and can reach as far as 1e14, so that a camera "
                   "may stand off: correct its "
                   "spacing (--spacing) and origin, or give a smaller transform.scale",
                   check->place, reach);
  if (!affine3_invert(placement, &inverse))
    return hl_check_refuse(check, "file",
                           "the volume's axes lie in one plane: mend its spacing or direction");
  return HL_OK;
}

/* Checks the data values of a volume. If the volume stores floats, the function also checks the stored
 * values. */
static hl_status check_values(const hl_checker *check, const hl_volume *volume) {
  double greatest = fmax(fabs(volume->minimum), fabs(volume->maximum)), stored = 0;
  if (volume->storage == HL_STORAGE_F32)
    stored = (greatest + fabs(volume->value_offset)) / fabs(volume->value_scale);
  if (greatest <= HL_LIMIT_VOXEL_VALUE && stored <= HL_LIMIT_VOXEL_VALUE) return HL_OK;
  return hl_fail(check->error, HL_ERROR_INPUT,
                 "%s/file: its voxels reach %.3g, more than the 1e36 that pictures can be computed with: "
                 "scale them, and mark "
                 "missing ones by NaN",
                 check->place, fmax(greatest, stored));
}

/* A volume that is drawn by its labels has no transfer function. */
static hl_status check_look(const hl_checker *check, const hl_scene_volume *volume) {
  char place[120];
  snprintf(place, sizeof place, "%s/transfer_function", check->place);
  hl_status status = HL_OK;
  if (volume->label_count == 0)
    status = hl_transfer_function_check(&volume->transfer_function, place, check->error);
  if (status == HL_OK) status = hl_check_key(check, HL_SETTINGS_VOLUME, "shading", volume);
  snprintf(place, sizeof place, "%s/material", check->place);
  if (status == HL_OK)
    status = hl_settings_check(HL_SETTINGS_MATERIAL, &volume->material, 0, place, check->error);
  static const char *const keys[] = {"attenuation_color", "scattering/anisotropy", "scattering/albedo",
                                     "scraps/faint",      "scraps/firm",           "scraps/least"};
  for (size_t k = 0; status == HL_OK && k < sizeof keys / sizeof *keys; k++)
    status = hl_check_key(check, HL_SETTINGS_VOLUME, keys[k], volume);
  return status;
}

static hl_status check_iso(const hl_checker *check, const hl_scene_volume *volume) {
  hl_status status = hl_check_count(check, "iso", volume->iso, volume->iso_count, HL_LIMIT_ISO);
  for (size_t i = 0; i < volume->iso_count && status == HL_OK; i++) {
    char place[120];
    snprintf(place, sizeof place, "%s/iso/%zu", check->place, i);
    status = hl_settings_check(HL_SETTINGS_ISO, &volume->iso[i], 0, place, check->error);
  }
  return status;
}

/* Checks a list of labels. list: the key of the list in the scene. */
static hl_status check_labels(const hl_checker *check, const char *list, const hl_label *labels,
                              size_t count) {
  hl_status status = hl_check_count(check, list, labels, count, HL_MOST_LABELS);
  for (size_t n = 0; status == HL_OK && n < count; n++) {
    const hl_label *label = &labels[n];
    char key[64];
    snprintf(key, sizeof key, "%s/%zu/value", list, n);
    if (n > 0 && label->value <= label[-1].value)
      status = hl_check_refuse(check, key,
                               "does not come after the label before: sort them by number, each once");
    snprintf(key, sizeof key, "%s/%zu/opacity", list, n);
    if (status == HL_OK)
      status = hl_check_range(check, key, label->opacity, 0, 1, "give an opacity from 0 to 1");
    snprintf(key, sizeof key, "%s/%zu/tint", list, n);
    if (status == HL_OK) status = hl_check_range(check, key, label->tint, 0, 1, "give a tint from 0 to 1");
    for (int c = 0; c < 3 && status == HL_OK; c++) {
      snprintf(key, sizeof key, "%s/%zu/color/%d", list, n, c);
      status = hl_check_range(check, key, label->color[c], 0, 1, "give linear RGB, each from 0 to 1");
    }
  }
  return status;
}

static hl_status check_mask(const hl_checker *check, const hl_scene_volume *volume) {
  const hl_mask *mask = &volume->mask;
  if (mask->volume == NULL)
    return mask->label_count == 0 ? HL_OK : hl_check_refuse(check, "mask", "has no label map: give its file");
  if (volume->label_count > 0)
    return hl_check_refuse(check, "mask", "and labels exclude each other: remove one");
  size_t voxels = hl_volume_voxel_count(mask->volume);
  if (voxels > HL_MASK_VOXELS)
    return hl_fail(check->error, HL_ERROR_UNSUPPORTED, "%s/mask: has %zu voxels, at most %zu can be",
                   check->place, voxels, HL_MASK_VOXELS);
  hl_status status = check_labels(check, "mask/labels", mask->labels, mask->label_count);
  return status == HL_OK ? hl_check_range(check, "mask/rest", mask->rest, 0, 1, "give a factor from 0 to 1")
                         : status;
}

hl_status hl_scene_volume_check(const hl_scene_volume *volume, size_t index, hl_error *error) {
  hl_checker check = {error, ""};
  snprintf(check.place, sizeof check.place, "/volumes/%zu", index);
  if (volume->volume == NULL)
    return hl_fail(error, HL_ERROR_ARGUMENT, "%s/volume: is null: give a volume", check.place);
  if (volume->file != NULL && volume->shapes != NULL)
    return hl_check_refuse(&check, "shapes", "and file exclude each other: the voxels came from one of them");
  hl_status status = check_values(&check, volume->volume);
  if (status == HL_OK) status = check_transform(&check, volume);
  if (status == HL_OK) status = check_placement(&check, volume);
  if (status == HL_OK) status = check_labels(&check, "labels", volume->labels, volume->label_count);
  if (status == HL_OK) status = check_mask(&check, volume);
  if (status == HL_OK) status = check_look(&check, volume);
  if (status == HL_OK) status = check_iso(&check, volume);
  if (status == HL_OK && volume->label_count > 0 && volume->iso_count > 0)
    status = hl_check_refuse(&check, "iso", "and labels exclude each other: remove one");
  if (status == HL_OK) status = check_clip(&check, volume);
  return status == HL_OK ? check_cuts(&check, volume) : status;
}
