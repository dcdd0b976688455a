/* reference/shade_surface.c - finds the light that a point of a mesh or of an isosurface sends to the eye;
 * eqs. (3) and (4). */
#include "elementary/elementary.h"
#include "mesh/mesh.h"
#include "reference/reference.h"

/* The normal, of any length, at a corner of a triangle. At a crease of the mesh, the corner has a normal of
 * its own; elsewhere the corner has the normal of the vertex. */
static vec3 corner_normal(const reference *all, const hl_scene_mesh *mesh, size_t triangle, int i) {
  const hl_mesh *of = mesh->mesh;
  const vec3 *normals = all->surfaces.normals + all->surfaces.first_normal[mesh - all->scene->meshes];
  uint32_t edge = of->edges != NULL ? of->edges[triangle][i] : HL_NO_EDGE;
  if (edge == HL_NO_EDGE) return normals[of->description.triangles[triangle][i]];
  const float *own = of->edge_normals[edge];
  return mat3_apply(hl_scene_mesh_to_world(mesh).linear, (vec3){own[0], own[1], own[2]});
}

static vec3 normal_of(const reference *all, const reference_hit *hit, vec3 flat) {
  vec3 sum = {0, 0, 0};
  for (int i = 0; i < 3; i++) {
    vec3 own = vec3_normalise(corner_normal(all, hit->triangle->mesh, hit->triangle->index, i));
    double along = vec3_dot(own, flat);
    bool rounded = fabs(along) >= HL_MESH_ROUNDED;
    if (!rounded) own = flat;
    sum = vec3_add(sum, vec3_scale(own, along < 0 && rounded ? -hit->weight[i] : hit->weight[i]));
  }
  return vec3_normalise(sum);
}

static void color_of(const reference_hit *hit, double color[3]) {
  const hl_scene_mesh *mesh = hit->triangle->mesh;
  const hl_mesh_description *d = &mesh->mesh->description;
  size_t index = hit->triangle->index;
  bool sphere = hit->triangle->radius > 0;
  const float *own = sphere && d->sphere_colors != NULL  ? d->sphere_colors[index]
                     : !sphere && d->face_colors != NULL ? d->face_colors[index]
                                                         : NULL;
  for (int c = 0; c < 3; c++) {
    double sum = own != NULL ? (double)own[c] : 1;
    if (!sphere && own == NULL && d->colors != NULL) {
      sum = 0;
      for (int i = 0; i < 3; i++) sum += hit->weight[i] * d->colors[d->triangles[index][i]][c];
    }
    color[c] = sum * mesh->color[c];
  }
}

/* The unit normal of the triangle, or of the sphere at the point. */
static vec3 flat_normal(const reference_hit *hit, vec3 point) {
  const vec3 *corner = hit->triangle->corner;
  if (hit->triangle->radius > 0) return vec3_normalise(vec3_subtract(point, corner[2]));
  return vec3_normalise(vec3_cross(vec3_subtract(corner[1], corner[0]), vec3_subtract(corner[2], corner[0])));
}

/* Adds the light of one source that the surface point sends to the eye, by eqs. (3) and (4). */
static void add_light(const reference *all, size_t light, const reference_surface_point *at,
                      reference_worker *worker, light_part *part) {
  const hl_material *material = &at->material;
  double reach[3];
  arrival arrived;
  hl_reference_light_arrive(&all->lights[light], at->point, &arrived);
  double cosine = vec3_dot(at->normal, arrived.towards);
  if (cosine <= 0 && !all->all_shadows) return;
  const reference_receiver receiver = {.point = at->point};
  hl_reference_light_reach(all, &all->lights[light], &receiver, at->receives_shadow, worker, reach);
  if (all->all_shadows)
    hl_reference_light_shadow(all, &all->lights[light], &receiver, at->receives_shadow, reach, worker,
                              part->shadow);
  if (cosine <= 0 && all->lights[light].points != NULL && at->receives_shadow)
    for (int c = 0; c < 3; c++) part->shadow[c] *= at->behind[c];
  if (cosine <= 0) return;
  vec3 reflected = vec3_subtract(vec3_scale(at->normal, 2 * cosine), arrived.towards);
  double gloss = material->specular * hl_pow(fmax(vec3_dot(at->to_eye, reflected), 0), material->shininess);
  for (int c = 0; c < 3; c++)
    part->picture[c] = (at->color[c] * material->diffuse * cosine + gloss) * arrived.incoming[c] * reach[c];
}

static void add_sky(const reference *all, const reference_surface_point *at, reference_worker *worker,
                    reference_parts *sample) {
  reference_sky_light light;
  hl_reference_sky_arrive(all,
                          &(reference_sky_receiver){.point = at->point,
                                                    .normal = at->normal,
                                                    .to_eye = at->to_eye,
                                                    .surface = 1,
                                                    .receives_shadow = at->receives_shadow,
                                                    .diffuse = at->material.diffuse},
                          worker, &light);
  for (int c = 0; c < 3; c++) {
    sample->sky[c] = at->color[c] * light.reaching[c];
    sample->sky_reaching[c] = light.reaching[c];
    sample->sky_open[c] = light.open[c];
  }
}

/* Finds the normal, the colour and the material at the point where the ray meets a triangle or a sphere.
 * Returns whether the ray meets the back of the triangle or sphere. */
static bool find_mesh_point(const reference *all, const reference_hit *hit, reference_surface_point *at) {
  const hl_scene_mesh *mesh = hit->triangle->mesh;
  vec3 flat = flat_normal(hit, at->point);
  bool behind = vec3_dot(flat, at->to_eye) < 0;
  at->normal = mesh->smooth && hit->triangle->radius == 0 ? normal_of(all, hit, flat) : flat;
  if (behind) at->normal = vec3_scale(at->normal, -1);
  color_of(hit, at->color);
  at->material = mesh->material;
  for (int c = 0; c < 3; c++) at->behind[c] = 1 - hit->opacity * mesh->attenuation_color[c];
  at->receives_shadow = mesh->receives_shadow;
  return behind;
}

static void find_iso_point(const reference_hit *hit, reference_surface_point *at) {
  const hl_scene_volume *volume = hit->volume->described;
  at->normal = hl_reference_iso_normal(hit, at->point);
  if (vec3_dot(at->normal, at->to_eye) < 0) at->normal = vec3_scale(at->normal, -1);
  hl_reference_iso_color(hit, at->point, at->color);
  for (int c = 0; c < 3; c++) at->behind[c] = 1 - hit->opacity;
  at->material = volume->shading == HL_SHADING_FLAT ? (hl_material){.emission = 1} : volume->material;
  at->receives_shadow = volume->receives_shadow && volume->shading != HL_SHADING_FLAT;
}

static int object_of(const reference *all, const reference_hit *hit) {
  if (hit->iso != NULL) return (int)(hit->volume - all->volumes) + 1;
  return (int)(all->scene->volume_count + (size_t)(hit->triangle->mesh - all->scene->meshes)) + 1;
}

void hl_reference_surface_shade(const reference *all, const reference_hit *hit, const reference_ray *ray,
                                reference_worker *worker) {
  reference_parts *sample = &worker->sample;
  reference_surface_point at = {.point = vec3_add(ray->origin, vec3_scale(ray->direction, hit->distance)),
                                .to_eye = vec3_scale(ray->direction, -1)};
  bool dark = false;
  if (hit->iso != NULL) find_iso_point(hit, &at);
  else dark = find_mesh_point(all, hit, &at) && !hit->triangle->mesh->two_sided;
  if (dark) {
    at.normal = (vec3){0, 0, 0};
    at.material = (hl_material){0};
  }
  hl_reference_parts_clear(sample, all->scene->light_count);
  sample->weight = 1;
  sample->object = object_of(all, hit);
  sample->normal = at.normal;
  sample->depth = hit->distance;
  for (int c = 0; c < 3; c++) {
    sample->ambient[c] = at.color[c] * at.material.ambient * all->scene->ambient[c];
    sample->emission[c] = at.color[c] * at.material.emission;
  }
  add_sky(all, &at, worker, sample);
  for (size_t l = 0; l < all->scene->light_count; l++) add_light(all, l, &at, worker, &sample->lights[l]);
}
