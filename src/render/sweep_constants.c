/* render/sweep_constants.c - see sweep_constants.h. */
#include "render/sweep_constants.h"

#include <math.h>

#include "grid/relevant.h"
#include "image/srgb.h"
#include "volume/colors.h"

enum { SRGB_CODES = 256 };

void hl_sweep_constants_lay_out(const frame_plan *plan, sweep_constants *constants, hl_layout *layout) {
  const size_t volumes = (size_t)plan->volumes.count;
  size_t cuts = 0;
  for (size_t g = 0; g < volumes; g++) cuts += plan->volumes.grids[g].cut_count;
  constants->volumes = hl_layout_take(layout, volumes, sizeof *constants->volumes);
  constants->cuts = hl_layout_take(layout, cuts, sizeof *constants->cuts);
  constants->srgb_decode = hl_layout_take(layout, SRGB_CODES, sizeof *constants->srgb_decode);
  constants->tint_decode = hl_layout_take(layout, SRGB_CODES, sizeof *constants->tint_decode);
}

/* ---- the volumes ---- */

/* Sets the place of the colours of a volume's voxels in memory. volume: null if there are no colours. 32 bits
 * hold the indices of colours, because a volume with colours has at most 2^29 voxels. */
static voxel_colors colors_of(const hl_volume *volume, const float *decode) {
  voxel_colors colors = {.decode = decode};
  if (volume == NULL || volume->colors == NULL) return colors;
  colors.voxels = volume->colors;
  int32_t step = HL_COLOR_BYTES;
  for (int axis = 0; axis < 3; axis++) {
    colors.last[axis] = (int32_t)volume->dimension[axis] - 1;
    colors.step_bytes[axis] = step;
    if (axis < 2) step *= (int32_t)volume->dimension[axis];
  }
  return colors;
}

static void set_up_colors(const plan_volumes *volumes, sweep_constants *constants) {
  bool any = false;
  for (int g = 0; g < volumes->count; g++) any = any || volumes->list[g].volume->colors != NULL;
  for (int code = 0; any && code < SRGB_CODES; code++)
    constants->srgb_decode[code] = (float)hl_srgb_decode(code / 255.0);
  for (int code = 0; code < SRGB_CODES; code++)
    constants->tint_decode[code] = (float)(code * code) * (1.0f / (255 * 255));
}

static void set_up_cut(const grid *grid, const cut_shape *shape, shade_cut *cut) {
  affine3 from_frame = affine3_multiply(shape->to_shape, grid->frame_to_index);
  *cut = (shade_cut){.type = (int)shape->type, .keep_inside = shape->keep_inside};
  affine3_store(cut->rows, &from_frame);
}

static void set_up_cuts(const plan_volumes *volumes, sweep_constants *constants) {
  shade_cut *cut = constants->cuts;
  for (int g = 0; g < volumes->count; g++) {
    const grid *grid = &volumes->grids[g];
    shade_volume *shade = &constants->volumes[g];
    shade->cuts = cut;
    shade->cut_count = (int)grid->cut_count;
    shade->light_cut_count = grid->cut_casts_shadow ? 0 : shade->cut_count;
    shade->cut_shading = (int)volumes->list[g].look.cut_shading;
    for (size_t i = 0; i < grid->cut_count; i++) set_up_cut(grid, &grid->cuts[i], cut++);
  }
}

/* Finds the faces of a volume's box that cut visible matter: the faces at which no other volume continues the
 * matter. */
static void find_box_faces(const grid *grid, shade_volume *shade) {
  for (int axis = 0; axis < 3; axis++) {
    const float at[2] = {grid->face_low[axis], grid->face_high[axis]};
    for (int high = 0; high < 2; high++) {
      const bool cuts = grid->face_shows[axis][high] && fabsf(at[high]) < FACE_FAR_OUT;
      shade->face_cuts[axis][high] = cuts ? -1 : 0;
      shade->any_face = shade->any_face || cuts;
    }
  }
}

/* Sets a volume's material, and the numbers that follow from it. */
static shade_volume material_of(const frame_volume *volume, const plan_fields *fields) {
  shade_volume shade = {
      .phong = volume->look.shading == HL_SHADING_PHONG,
      .lit = volume->look.shading != HL_SHADING_FLAT,
      .visible = volume->visible,
      .receives_shadow = volume->receives_shadow,
      .ambient = (float)volume->look.material.ambient,
      .diffuse = (float)volume->look.material.diffuse,
      .specular = (float)volume->look.material.specular,
      .shininess = (float)volume->look.material.shininess,
      .anisotropy = (float)volume->look.anisotropy,
      .phase_once = hl_phase_table(fields->phases, volume->look.anisotropy),
      .phase_twice = hl_phase_table(fields->phases, volume->look.anisotropy * volume->look.anisotropy),
      .multiple = volume->look.multiple_scattering};
  for (int c = 0; c < HL_CHANNELS; c++) {
    shade.albedo[c] = (float)volume->look.albedo[c];
    shade.absorbs = shade.absorbs || volume->look.albedo[c] != 1;
    shade.cast[c] = volume->casts_shadow ? (float)volume->look.attenuation_color[c] : 0;
  }
  shade.emission = shade.lit ? (float)volume->look.material.emission : 1;
  if (!shade.lit) shade.ambient = shade.receives_shadow = 0;
  return shade;
}

/* Sets the members that describe where a volume lies and how large its voxels are. */
static void place_volume(const grid *grid, shade_volume *shade) {
  shade->voxel = (float)hl_smallest_edge(grid);
  affine3_store(shade->to_index, &grid->frame_to_index);
  for (int axis = 0; axis < 3; axis++) {
    shade->low[axis] = (float)grid->box_low[axis];
    shade->high[axis] = (float)grid->box_high[axis];
  }
}

static void set_up_volumes(const frame_plan *plan, sweep_constants *constants) {
  const plan_volumes *volumes = &plan->volumes;
  int rank = 0;
  set_up_colors(volumes, constants);
  for (int g = 0; g < volumes->count; g++) {
    const frame_volume *of = &volumes->list[g];
    const grid *grid = &volumes->grids[g];
    shade_volume *shade = &constants->volumes[g];
    *shade = material_of(of, &plan->fields);
    shade->classifier = of->classifier;
    shade->grid = grid;
    shade->kernel = volumes->kernel;
    shade->object = of->object;
    shade->colors = colors_of(of->volume, constants->srgb_decode);
    shade->tints = colors_of(of->tints, constants->tint_decode);
    if (volumes->shown != NULL && shade->visible) {
      shade->rank = rank++;
      shade->shown = (const float(*)[4])volumes->shown[g];
    }
    place_volume(grid, shade);
    if (of->look.cut_shading != HL_CUT_SHADING_GRADIENT) find_box_faces(grid, shade);
    shade->mask_faces = shade->phong && shade->classifier->mask.slopes != NULL &&
                        of->look.cut_shading == HL_CUT_SHADING_FACE;
  }
  set_up_cuts(volumes, constants);
}

/* ---- the lights and the picture ---- */

static void set_up_light(const frame_plan *plan, const sweep_plan *sweep, int index, shade_light *light) {
  const light_plan *from = &sweep->lights[index];
  const light_source *source = from->source;
  const frame_light *whole = &plan->lights[source->row];
  const sheet_stack *sheets = &sweep->geometry->sheets;
  *light = (shade_light){.parallel = source->parallel,
                         .shadowed = from->shadow.method != NULL,
                         .inverse_square = whole->is_inverse_square,
                         .sector = hl_sector_fraction(source->sectors, source->sector),
                         .number = index,
                         .parallel_row = source->parallel && whole->is_wide ? source->row : -1,
                         .cone = hl_light_cone(source, plan->frame.content.middle, plan->frame.middle_pixel),
                         .nearest = plan->settings.shadow_lookup == HL_LOOKUP_NEAREST,
                         .cubic = from->shadow.plan.cubic};
  light->of_sky = (float)source->of_sky;
  if (plan->fields.phases->count > 0) light->caps = hl_light_caps(source);
  vec3_store(light->towards, vec3_scale(source->direction, -1));
  vec3_store(light->position, source->position);
  for (int c = 0; c < 3; c++)
    light->color[c] = (float)(whole->color[c] * whole->intensity *
                              (from->emission == NULL ? 1 : from->emission->mean[c]));
  light->path = (float)sheets->spacing;
  if (source->parallel)
    light->path = (float)(sheets->spacing / fmax(fabs(vec3_dot(source->direction, sheets->normal)), 1e-3));
}

static void set_up_picture(const frame_plan *plan, const sweep_plan *sweep, sweep_constants *constants) {
  const view *eye = &plan->frame.eye;
  const vec3 normal = sweep->geometry->sheets.normal;
  const double spacing = sweep->geometry->sheets.spacing;
  const bool first = sweep->adds_even_light;
  shade_job *shade = &constants->shade;
  *shade = (shade_job){.path = (float)spacing,
                       .spacing = (float)spacing,
                       .back_to_front = sweep->geometry->back_to_front,
                       .lights = constants->lights,
                       .light_count = sweep->geometry->light_count,
                       .channels = plan->channels,
                       .scattered = first ? plan->fields.scattered : NULL,
                       .sky = first ? plan->fields.sky : NULL,
                       .emission = first ? 1 : 0};
  vec3_store(shade->normal, normal);
  vec3_store(shade->eye, eye->origin);
  if (!eye->perspective) {
    double climb = vec3_dot(eye->direction, normal);
    shade->path = (float)(spacing / fabs(climb));
    vec3_store(shade->through, vec3_scale(eye->direction, spacing / climb));
    vec3_store(shade->towards_eye, vec3_scale(eye->direction, -1));
  }
  for (int c = 0; c < 3 && first; c++) shade->ambient[c] = (float)plan->ambient[c];
}

texture_use hl_texture_use(const frame *frame) {
  return (texture_use){frame->content.points, frame->content.point_count, frame->content.middle,
                       frame->middle_pixel};
}

void hl_sweep_constants_find(const frame_plan *plan, const sweep_plan *sweep, sweep_constants *constants) {
  const sheet_stack *sheets = &sweep->geometry->sheets;
  set_up_volumes(plan, constants);
  set_up_picture(plan, sweep, constants);
  for (int i = 0; i < sweep->geometry->light_count; i++) {
    set_up_light(plan, sweep, i, &constants->lights[i]);
    attenuate_job *job = &constants->attenuate[i];
    *job = (attenuate_job){
        .path = constants->lights[i].path, .spacing = (float)sheets->spacing, .channels = plan->channels};
    const light_source *source = sweep->lights[i].source;
    if (source->parallel)
      vec3_store(job->through,
                 vec3_scale(source->direction,
                            sheets->spacing / fmax(vec3_dot(source->direction, sheets->normal), 1e-3)));
  }
}
