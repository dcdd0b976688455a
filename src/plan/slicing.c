/* plan/slicing.c - chooses the direction of the sheets (section 3.1 of the paper), and the lights that share
 * a sweep. */
#include "plan/slicing.h"

#include "core/sheet_constants.h"
#include "elementary/elementary.h"
#include "scene/light/light_kind.h"

/* The cosine of 60 degrees. Lights share a sweep only if the eye's direction and the direction of each light
 * are within this angle of the slicing axis. */
static const double STEEPEST = 0.5;

/* The least allowed |cos| of the angle between a ray and the slicing axis; a frame with a smaller |cos| is
 * refused. FLATTEST_EYE_RAY: for the picture's outermost rays (87 degrees). FLATTEST_LIGHT: for a light's
 * direction (80 degrees). */
static const double FLATTEST_EYE_RAY = 0.05, FLATTEST_LIGHT = 0.17;

/* The least |cos| of the angle between a slicing axis h and the eye's rays through the picture's corners. The
 * result is 0 unless all these rays cross the sheets in the same direction. */
static double flattest_eye_ray(const view *eye, vec3 h) {
  double least = INFINITY, sense = 0;
  for (int corner = 0; corner < 4; corner++) {
    vec3 start, way;
    hl_view_ray(eye, corner & 1 ? eye->width : 0, corner & 2 ? eye->height : 0, &start, &way);
    double crossing = vec3_dot(vec3_normalise(way), h);
    if (sense == 0) sense = crossing;
    if (crossing * sense <= 0) return 0;
    least = fmin(least, fabs(crossing));
  }
  return least;
}

/* The slicing axis h for the eye's direction e and a light's direction l: normalise(e + l) if e.l >= 0, else
 * normalise(l - e) (fig. 3 of the paper). For several lights, l is the sum of their directions. In a wide
 * picture, rays through the corners may run along these sheets. In such a picture, h leans towards the eye
 * until all rays cross the sheets. */
static vec3 slicing_axis(const frame *frame, const hl_render_settings *settings, vec3 light,
                         bool *back_to_front) {
  *back_to_front = vec3_dot(frame->eye_direction, light) < 0;
  vec3 e = *back_to_front ? vec3_scale(frame->eye_direction, -1) : frame->eye_direction;
  if (settings->slicing == HL_SLICING_IMAGE_ALIGNED) return e;
  vec3 h = vec3_normalise(vec3_add(e, light));
  double flattest = flattest_eye_ray(&frame->eye, h);
  for (int lean = 0; lean < 16 && flattest < 0.2; lean++) {
    vec3 leaning = vec3_normalise(vec3_add(h, vec3_scale(e, 0.25)));
    if (vec3_dot(leaning, light) < (flattest < FLATTEST_EYE_RAY ? FLATTEST_LIGHT : 0.3)) break;
    h = leaning;
    flattest = flattest_eye_ray(&frame->eye, h);
  }
  return h;
}

/* Limits of the cosine of the angle between the slicing axis and a light's rays to the content. FLATTEST: 78
 * degrees. FLATTEST_ALONE: 70 degrees, for a soft parallel light that has a sweep of its own; with flatter
 * rays, floors would shade themselves. */
static const double FLATTEST = 0.2, FLATTEST_ALONE = 0.35;

/* Returns whether, for all rays of a light, the cosine of the angle to the sheets' normal is at least
 * `least`. The rays come from the centre of a near light, or from the whole disk of a soft parallel light. */
static bool rays_cross(const frame *frame, const light_source *source, vec3 h, double least) {
  if (source->parallel) {
    double off = hl_acos(fmin(fmax(vec3_dot(source->direction, h), -1), 1));
    return source->shadows != HL_SHADOWS_SOFT || off + hl_atan(source->shape.radius) < hl_acos(least);
  }
  for (int i = 0; i < frame->content.point_count; i++) {
    vec3 way = vec3_subtract(frame->content.points[i], source->position);
    if (vec3_dot(way, h) <= least * vec3_length(way)) return false;
  }
  return true;
}

/* Finds the axis of about the narrowest cone around a light's rays to the corners of the content. In each
 * step the axis moves towards the ray that is farthest from it, and each step is smaller than the one before
 * (Badoiu and Clarkson, "Smaller core-sets for balls", 2003, applied to directions). */
static vec3 middle_of_rays(const frame *frame, const light_source *source) {
  enum { STEPS = 64 };
  vec3 middle = source->direction;
  for (int step = 1; step <= STEPS; step++) {
    vec3 farthest = middle;
    double least = INFINITY;
    for (int i = 0; i < frame->content.point_count; i++) {
      vec3 way = vec3_normalise(vec3_subtract(frame->content.points[i], source->position));
      if (vec3_dot(way, middle) < least) {
        least = vec3_dot(way, middle);
        farthest = way;
      }
    }
    vec3 towards = vec3_add(middle, vec3_scale(vec3_subtract(farthest, middle), 1.0 / (step + 1)));
    if (vec3_length(towards) > 1e-6) middle = vec3_normalise(towards);
  }
  return middle;
}

static vec3 lean_towards(vec3 h, vec3 axis, double fraction) {
  return vec3_normalise(vec3_add(vec3_scale(h, 1 - fraction), vec3_scale(axis, fraction)));
}

static bool eye_crosses(const frame *frame, vec3 h, bool back_to_front) {
  double e = vec3_dot(frame->eye_direction, h) * (back_to_front ? -1 : 1);
  return e > 0 && flattest_eye_ray(&frame->eye, h) >= FLATTEST;
}

/* The slicing axis of one light. Some rays of a near light, or of a wide parallel light, may not cross the
 * sheets of the half-way vector. For such a light, the axis leans towards the middle of the light's rays, but
 * no farther than needed. So the axis moves without a jump as the light moves. For a parallel light, the axis
 * leans no farther than the eye allows. Returns false if no sheets suit both a near light and the eye. */
static bool axis_of_light(const frame *frame, const hl_render_settings *settings, const light_source *source,
                          vec3 *h, bool *back_to_front) {
  const bool wide = source->parallel;
  const double least = wide ? FLATTEST_ALONE : FLATTEST;
  *h = slicing_axis(frame, settings, source->direction, back_to_front);
  if (settings->slicing == HL_SLICING_IMAGE_ALIGNED || rays_cross(frame, source, *h, least)) return true;
  vec3 middle = wide ? source->direction : middle_of_rays(frame, source);
  if (!wide && !rays_cross(frame, source, middle, least)) return false;
  double low = 0, high = 1;
  for (int i = 0; i < 40; i++) {
    double fraction = (low + high) / 2;
    vec3 leaning = lean_towards(*h, middle, fraction);
    bool enough = rays_cross(frame, source, leaning, least) ||
                  (wide && !eye_crosses(frame, leaning, *back_to_front));
    if (enough) high = fraction;
    else low = fraction;
  }
  vec3 leaning = lean_towards(*h, middle, wide ? low : high);
  if (!eye_crosses(frame, leaning, *back_to_front)) return wide;
  *h = leaning;
  return true;
}

/* Returns whether the same sheets suit a light and the eye. If not, the light must be divided into
 * sectors. */
static bool serves(const frame *frame, const hl_render_settings *settings, const light_source *source) {
  bool back_to_front;
  vec3 h;
  return axis_of_light(frame, settings, source, &h, &back_to_front);
}

/* ---- the lights ---- */

/* The angle between the eye's outermost ray and the eye's direction. */
static double widest_ray(const frame *frame) {
  double least = 1;
  for (int corner = 0; corner < 4; corner++) {
    vec3 start, way;
    hl_view_ray(&frame->eye, corner & 1 ? frame->eye.width : 0, corner & 2 ? frame->eye.height : 0, &start,
                &way);
    least = fmin(least, vec3_dot(vec3_normalise(way), frame->eye_direction));
  }
  return hl_acos(fmax(least, -1));
}

void hl_frame_set_up_lights(frame *frame, const framed_scene *framed) {
  const hl_scene_description *scene = &framed->scene;
  frame->sectors = hl_light_sectors(frame->eye_direction, widest_ray(frame));
  frame->light_count = 0;
  for (size_t i = 0; i < scene->light_count && !hl_is_maximum(&scene->render); i++) {
    const hl_light *light = &scene->lights[i];
    light_source source = hl_light_source(light, &scene->render, frame->content.middle);
    source.light_index = framed->order->lights[i];
    source.row = (int)i;
    source.of_sky = framed->sun_parts[i];
    if (!hl_is_lit(scene)) source.shadows = HL_SHADOWS_OFF;
    bool narrow = (hl_light_kind(light)->cone && light->opening_angle_deg <= 120) ||
                  light->texture.pixels != NULL;
    bool whole = source.shadows == HL_SHADOWS_OFF || narrow || serves(frame, &scene->render, &source);
    for (int sector = 0; sector < (whole ? 1 : LIGHT_SECTORS); sector++)
      frame->lights[frame->light_count++] = whole ? source
                                                  : hl_light_in_sector(&source, &frame->sectors, sector);
  }
}

/* ---- the sweeps ---- */

static bool axis_serves(const frame *frame, const sweep_sheets *sweep, vec3 h, bool back_to_front) {
  double e = vec3_dot(frame->eye_direction, h) * (back_to_front ? -1 : 1);
  if (e < STEEPEST) return false;
  for (int i = 0; i < sweep->light_count; i++) {
    const light_source *source = &frame->lights[sweep->light[i]];
    if (vec3_dot(source->direction, h) < STEEPEST || !rays_cross(frame, source, h, FLATTEST)) return false;
  }
  return true;
}

static vec3 sum_of_directions(const frame *frame, const sweep_sheets *sweep) {
  vec3 sum = {0, 0, 0};
  for (int i = 0; i < sweep->light_count; i++) sum = vec3_add(sum, frame->lights[sweep->light[i]].direction);
  return vec3_normalise(sum);
}

/* Adds a light to a sweep if one slicing axis suits both the sweep's lights and this light. Returns whether
 * the light was added. */
static bool try_light(const frame *frame, const hl_render_settings *settings, sweep_sheets *sweep,
                      int light) {
  if (sweep->light_count == FRAME_LIGHTS || sweep->of_sectors) return false;
  sweep->light[sweep->light_count++] = light;
  bool back_to_front;
  vec3 h;
  if (sweep->light_count == 1)
    (void)axis_of_light(frame, settings, &frame->lights[light], &h, &back_to_front);
  else h = slicing_axis(frame, settings, sum_of_directions(frame, sweep), &back_to_front);
  if (sweep->light_count == 1 || axis_serves(frame, sweep, h, back_to_front)) {
    sweep->sheets.normal = h;
    sweep->back_to_front = back_to_front;
    return true;
  }
  sweep->light_count--;
  return false;
}

/* Lays sheets over the whole content, with one more sheet on either side. */
static void place_sheets(const frame *frame, sheet_stack *sheets) {
  double low = INFINITY, high = -INFINITY;
  for (int i = 0; i < frame->content.point_count; i++) {
    double height = vec3_dot(sheets->normal, frame->content.points[i]);
    low = fmin(low, height);
    high = fmax(high, height);
  }
  sheets->spacing = frame->spacing;
  double count = frame->content.point_count == 0 ? 0 : ceil((high - low) / sheets->spacing) + 3;
  sheets->count = (int)fmin(count, GREATEST_SHEETS + 1);
  sheets->first = (low + high) / 2 - (sheets->count - 1) * 0.5 * sheets->spacing;
}

/* Adds a sector of a light to the sweep that has sectors of the same direction; if no sweep has such sectors,
 * adds a sweep. */
static void add_sector(const frame *frame, int light, sweep_sheets *sweeps, int *count) {
  vec3 axis = frame->lights[light].direction;
  int s = 0;
  while (s < *count && !(sweeps[s].of_sectors && sweeps[s].light_count < FRAME_LIGHTS &&
                         frame->lights[sweeps[s].light[0]].sector == frame->lights[light].sector))
    s++;
  if (s == *count)
    sweeps[(*count)++] = (sweep_sheets){.sheets = {.normal = axis},
                                        .of_sectors = true,
                                        .back_to_front = vec3_dot(frame->eye_direction, axis) < 0};
  sweeps[s].light[sweeps[s].light_count++] = light;
}

static void add_shadowing_light(const frame *frame, const hl_render_settings *settings, int light,
                                sweep_sheets *sweeps, int *count) {
  if (frame->lights[light].sectors != NULL) {
    add_sector(frame, light, sweeps, count);
    return;
  }
  for (int s = 0; s < *count; s++)
    if (try_light(frame, settings, &sweeps[s], light)) return;
  sweeps[*count] = (sweep_sheets){0};
  (void)try_light(frame, settings, &sweeps[(*count)++], light);
}

/* The normal h of the added sweep's sheets is the eye's direction e (section 2.2 of the paper). */
void hl_frame_add_eye_sweep(const frame *frame, sweep_sheets *sweeps, int *count) {
  sweep_sheets *added = &sweeps[(*count)++];
  *added = (sweep_sheets){.sheets = {.normal = frame->eye_direction}};
  place_sheets(frame, &added->sheets);
}

/* Adds a light without shadows to any sweep with room. If no sweep has room, the function adds a sweep whose
 * sheets are parallel to the picture. light: the light's index; -1 if the function is only to make sure that
 * a sweep with room exists. */
static void add_plain_light(const frame *frame, int light, sweep_sheets *sweeps, int *count) {
  int s = 0;
  while (s < *count && sweeps[s].light_count == FRAME_LIGHTS) s++;
  if (s == *count) hl_frame_add_eye_sweep(frame, sweeps, count);
  if (light >= 0) sweeps[s].light[sweeps[s].light_count++] = light;
}

int hl_frame_sweeps(const frame *frame, const hl_render_settings *settings, sweep_sheets *sweeps) {
  int count = 0;
  for (int light = 0; light < frame->light_count; light++)
    if (frame->lights[light].shadows != HL_SHADOWS_OFF)
      add_shadowing_light(frame, settings, light, sweeps, &count);
  for (int light = 0; light < frame->light_count; light++)
    if (frame->lights[light].shadows == HL_SHADOWS_OFF) add_plain_light(frame, light, sweeps, &count);
  if (count == 0) add_plain_light(frame, -1, sweeps, &count);
  for (int s = 0; s < count; s++) place_sheets(frame, &sweeps[s].sheets);
  return count;
}

static bool has_sun(const frame *frame, const sweep_sheets *sweep) {
  bool any = false;
  for (int i = 0; i < sweep->light_count; i++) any |= frame->lights[sweep->light[i]].of_sky > 0;
  return any;
}

/* Refuses a sweep with too many sheets. */
static hl_status refuse_sheets(const frame *frame, const sheet_stack *sheets, hl_error *error) {
  bool can_rise = sheets->spacing < GRID_MARGIN * frame->content.voxel;
  return hl_fail(
      error, HL_ERROR_UNSUPPORTED,
      "/render/sheet_spacing: makes more than %d sheets of the volumes, whose smallest voxel edge is "
      "small beside their size: %scorrect the spacing of voxels (--spacing)",
      GREATEST_SHEETS, can_rise ? "raise it, or " : "");
}

hl_status hl_frame_check_sweeps(const frame *frame, const sweep_sheets *sweeps, int count, hl_error *error) {
  for (int s = 0; s < count; s++) {
    if (sweeps[s].sheets.count > GREATEST_SHEETS) return refuse_sheets(frame, &sweeps[s].sheets, error);
    if (flattest_eye_ray(&frame->eye, sweeps[s].sheets.normal) < FLATTEST_EYE_RAY)
      return hl_fail(
          error, HL_ERROR_UNSUPPORTED,
          "/camera/fovy_deg: no sheets are crossed by every ray of so wide a view%s: use a smaller angle%s",
          sweeps[s].light_count > 0 ? " and by the light" : "",
          sweeps[s].light_count == 0   ? ""
          : has_sun(frame, &sweeps[s]) ? ", or the sky without \"suns\""
                                       : ", or lights from ahead or behind");
    for (int i = 0; i < sweeps[s].light_count; i++) {
      int light = sweeps[s].light[i];
      if (frame->lights[light].shadows == HL_SHADOWS_OFF) continue;
      if (vec3_dot(frame->lights[light].direction, sweeps[s].sheets.normal) < FLATTEST_LIGHT)
        return hl_fail(error, HL_ERROR_UNSUPPORTED,
                       "/render/slicing: image-aligned sheets cannot carry the shadows of /lights/%d, which "
                       "comes from the "
                       "side: use half-vector",
                       frame->lights[light].light_index);
    }
  }
  return HL_OK;
}
