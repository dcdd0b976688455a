/* plan/frame.c - sets the eye's view, the lights and the bounds of the content in a frame. */
#include "plan/frame.h"

#include "elementary/elementary.h"
#include "grid/relevant.h"

static vec3 camera_up(const hl_camera *camera, vec3 forward) {
  vec3 up = vec3_normalise(vec3_of(camera->up));
  if (vec3_length(vec3_cross(forward, up)) > 1e-6) return up;
  return fabs(forward.z) < 0.9 ? (vec3){0, 0, 1} : (vec3){0, 1, 0};
}

hl_status hl_frame_eye(const hl_camera *camera, int width, int height, view *eye, hl_error *error) {
  vec3 position = vec3_of(camera->position);
  vec3 forward = vec3_normalise(vec3_subtract(vec3_of(camera->target), position));
  vec3 right = vec3_normalise(vec3_cross(forward, camera_up(camera, forward)));
  vec3 up = vec3_cross(right, forward);
  eye->perspective = camera->type == HL_CAMERA_PERSPECTIVE;
  double half_height = eye->perspective ? hl_tan(camera->fovy_deg * HL_PI / 360) : camera->height / 2;
  double half_width = half_height * width / height;
  eye->width = width;
  eye->height = height;
  eye->origin = position;
  eye->direction = forward;
  eye->corner = vec3_add(vec3_scale(up, half_height), vec3_scale(right, -half_width));
  eye->corner = vec3_add(eye->corner, eye->perspective ? forward : position);
  eye->du = vec3_scale(right, 2 * half_width / width);
  eye->dv = vec3_scale(up, -2 * half_height / height);
  if (!hl_view_finish(eye))
    return hl_fail(error, HL_ERROR_INPUT,
                   "/camera: position, target and up do not span a view: move one of them");
  return HL_OK;
}

void hl_frame_content(const grid *grid, vec3 corners[8]) {
  double low[3], high[3];
  hl_content_bounds(grid, 0.5, low, high);
  for (int corner = 0; corner < 8; corner++)
    corners[corner] = affine3_apply(
        grid->index_to_frame,
        (vec3){corner & 1 ? high[0] : low[0], corner & 2 ? high[1] : low[1], corner & 4 ? high[2] : low[2]});
}

/* A half space: all points x with normal . x + offset >= 0. */
typedef struct half_space {
  vec3 normal;
  double offset;
} half_space;

/* Cuts a segment to the part that lies within half spaces. Returns false if nothing is left. */
static bool clip_segment(vec3 *a, vec3 *b, const half_space *planes, int count) {
  for (int i = 0; i < count; i++) {
    double da = vec3_dot(planes[i].normal, *a) + planes[i].offset;
    double db = vec3_dot(planes[i].normal, *b) + planes[i].offset;
    if (da < 0 && db < 0) return false;
    if (da >= 0 && db >= 0) continue;
    vec3 crossing = vec3_add(*a, vec3_scale(vec3_subtract(*b, *a), da / (da - db)));
    if (da < 0) *a = crossing;
    else *b = crossing;
  }
  return true;
}

static half_space through(vec3 a, vec3 b, vec3 c, vec3 inside) {
  vec3 normal = vec3_normalise(vec3_cross(vec3_subtract(b, a), vec3_subtract(c, a)));
  half_space plane = {normal, -vec3_dot(normal, a)};
  if (vec3_dot(normal, inside) + plane.offset < 0)
    plane = (half_space){vec3_scale(normal, -1), -plane.offset};
  return plane;
}

/* Finds the corners and the side planes of the space that the eye's rays fill, out to a depth beyond all
 * content: a pyramid, or a beam for parallel rays. */
static void frustum(const view *eye, double depth, vec3 near[4], vec3 far[4], half_space planes[4]) {
  vec3 middle_start, middle_way;
  hl_view_ray(eye, eye->width / 2.0, eye->height / 2.0, &middle_start, &middle_way);
  for (int corner = 0; corner < 4; corner++) {
    vec3 way;
    double u = corner == 1 || corner == 2 ? eye->width + 1.0 : -1.0,
           v = corner >= 2 ? eye->height + 1.0 : -1.0;
    hl_view_ray(eye, u, v, &near[corner], &way);
    way = vec3_normalise(way);
    if (!eye->perspective) near[corner] = vec3_add(near[corner], vec3_scale(way, -depth));
    far[corner] = vec3_add(near[corner], vec3_scale(way, 2 * depth));
  }
  vec3 inside = vec3_add(middle_start, vec3_scale(middle_way, depth));
  for (int side = 0; side < 4; side++)
    planes[side] = through(near[side], far[side], far[(side + 1) % 4], inside);
}

static int visible_points_of_box(const frame *frame, const vec3 corner[8], vec3 *points) {
  static const int edges[12][2] = {{0, 1}, {2, 3}, {4, 5}, {6, 7}, {0, 2}, {1, 3},
                                   {4, 6}, {5, 7}, {0, 4}, {1, 5}, {2, 6}, {3, 7}};
  static const int faces[6][3] = {{0, 1, 2}, {4, 5, 6}, {0, 1, 4}, {2, 3, 6}, {0, 2, 4}, {1, 3, 5}};
  vec3 near[4], far[4], middle = vec3_scale(vec3_add(corner[0], corner[7]), 0.5);
  half_space sides[4], walls[6];
  double depth = vec3_length(vec3_subtract(frame->eye.origin, middle)) +
                 vec3_length(vec3_subtract(corner[7], corner[0]));
  int count = 0;
  frustum(&frame->eye, depth, near, far, sides);
  for (int face = 0; face < 6; face++)
    walls[face] = through(corner[faces[face][0]], corner[faces[face][1]], corner[faces[face][2]], middle);
  for (int edge = 0; edge < 12; edge++) {
    vec3 a = corner[edges[edge][0]], b = corner[edges[edge][1]];
    if (!clip_segment(&a, &b, sides, 4)) continue;
    points[count++] = a;
    points[count++] = b;
  }
  for (int side = 0; side < 4; side++) {
    vec3 a = near[side], b = far[side];
    if (!clip_segment(&a, &b, walls, 6)) continue;
    points[count++] = a;
    points[count++] = b;
  }
  return count;
}

int hl_frame_visible_points(const frame *frame, vec3 *points) {
  int count = 0;
  for (int box = 0; box < frame->content.point_count / 8; box++)
    count += visible_points_of_box(frame, frame->content.points + 8 * box, points + count);
  return count;
}

/* ---- the eye ---- */

/* The edge of the eye's pixel, projected to the nearest depth of the content. The nearest depth counts as at
 * least a third of the depth of the content's middle, because closer voxels are larger than pixels anyway. */
static double pixel_at_content(const frame *frame, double middle_depth) {
  const view *eye = &frame->eye;
  double edge = fmax(vec3_length(eye->du), vec3_length(eye->dv));
  if (!eye->perspective) return edge;
  double nearest = INFINITY;
  vec3 start, forward;
  hl_view_ray(eye, eye->width / 2.0, eye->height / 2.0, &start, &forward);
  for (int i = 0; i < frame->content.point_count; i++)
    nearest = fmin(nearest, vec3_dot(forward, vec3_subtract(frame->content.points[i], eye->origin)));
  return edge * fmax(nearest, middle_depth / 3);
}

/* The volume of a box whose corners hl_frame_content() found. The result is above 0 even if the box is flat.
 */
static double box_volume(const vec3 corners[8]) {
  vec3 x = vec3_subtract(corners[1], corners[0]), y = vec3_subtract(corners[2], corners[0]),
       z = vec3_subtract(corners[4], corners[0]);
  return fmax(fabs(vec3_dot(vec3_cross(x, y), z)), 1e-300);
}

/* The mean of the centres of the content's boxes, each weighted by the volume of its box. Derived: let a box
 * have the volume V and the centre c. If a box is cut into parts, the sum of V c over the parts equals V c of
 * the whole box. So a volume that is cut into parts keeps its middle, if the boxes around the relevant bricks
 * of the parts fill the box around all relevant bricks. The directions of near lights, and so the directions
 * of sheets, follow from the middle. */
static vec3 content_middle(const frame *frame) {
  vec3 sum = {0, 0, 0};
  double volumes = 0;
  for (int i = 0; i < frame->content.point_count; i += 8) {
    double volume = box_volume(frame->content.points + i);
    vec3 centre = vec3_scale(vec3_add(frame->content.points[i], frame->content.points[i + 7]), 0.5);
    sum = vec3_add(sum, vec3_scale(centre, volume));
    volumes += volume;
  }
  return frame->content.point_count == 0 ? sum : vec3_scale(sum, 1 / volumes);
}

/* Sets eye_direction and the sizes of pixels at the content. If the eye is outside the content, eye_direction
 * is half way between the direction straight ahead and the direction to the content's middle. Otherwise
 * eye_direction is the direction straight ahead. */
static void look(frame *frame) {
  vec3 start, forward;
  hl_view_ray(&frame->eye, frame->eye.width / 2.0, frame->eye.height / 2.0, &start, &forward);
  forward = vec3_normalise(forward);
  frame->eye_direction = forward;
  vec3 way = vec3_subtract(frame->content.middle, frame->eye.origin);
  double distance = vec3_length(way), radius = 0;
  for (int i = 0; i < frame->content.point_count; i++)
    radius = fmax(radius, vec3_length(vec3_subtract(frame->content.points[i], frame->content.middle)));
  if (frame->eye.perspective && distance > radius) {
    vec3 towards = vec3_normalise(way);
    if (vec3_dot(towards, forward) > 0.5) frame->eye_direction = vec3_normalise(vec3_add(towards, forward));
  }
  double middle_depth = frame->eye.perspective ? vec3_dot(forward, way) : 1;
  frame->pixel = pixel_at_content(frame, middle_depth);
  frame->middle_pixel = fmax(frame->pixel,
                             fmax(vec3_length(frame->eye.du), vec3_length(frame->eye.dv)) * middle_depth);
}

/* Voxels that are smaller than pixels could fall between pixels. So a frame of such a volume has smaller
 * pixels than the picture, about as large as voxels. A pixel of the picture is a mean of pixels of the frame.
 * GREATEST_OVERSAMPLING: the greatest number of the frame's pixels along a side of a picture's pixel.
 * GREATEST_OVERSAMPLED_SIDE: the greatest number of the frame's pixels along a side of the frame. */
enum { GREATEST_OVERSAMPLING = 8, GREATEST_OVERSAMPLED_SIDE = 4096 };

/* The oversampling of a frame: the number that the voxels need, or the number that the scene asks for if it
 * is greater. */

static int oversampling(const frame *frame, const hl_scene_description *scene) {
  int longer = scene->width > scene->height ? scene->width : scene->height,
      most = GREATEST_OVERSAMPLED_SIDE / longer;
  if (most > GREATEST_OVERSAMPLING) most = GREATEST_OVERSAMPLING;
  double wanted = floor(frame->middle_pixel / frame->content.voxel + 0.5);
  int needed = wanted > most ? most : (int)fmax(wanted, 1);
  return needed > scene->render.pixel_samples ? (needed < 1 ? 1 : needed) : scene->render.pixel_samples;
}

hl_status hl_frame_set_up_eye(frame *frame, const hl_scene_description *scene, hl_error *error) {
  frame->content.middle = content_middle(frame);
  for (frame->oversampling = 1;;) {
    frame->width = scene->width * frame->oversampling;
    frame->height = scene->height * frame->oversampling;
    hl_status status = hl_frame_eye(&scene->camera, frame->width, frame->height, &frame->eye, error);
    if (status != HL_OK) return status;
    look(frame);
    int wanted = frame->oversampling > 1 || frame->content.point_count == 0 ? 1 : oversampling(frame, scene);
    if (wanted == 1) return HL_OK;
    frame->oversampling = wanted;
  }
}

/* ---- the lights ---- */

bool hl_is_lit(const hl_scene_description *scene) {
  for (size_t i = 0; i < scene->volume_count && !hl_is_maximum(&scene->render); i++)
    if (scene->volumes[i].visible && scene->volumes[i].shading != HL_SHADING_FLAT) return true;
  for (size_t i = 0; i < scene->mesh_count; i++)
    if (scene->meshes[i].visible) return true;
  return false;
}
