/* volume/formats/dicom/stack.c - finds the frames of a series that are slices of one volume, and finds their
 * order and their distance.
 *
 * Source: DICOM PS3.3, C.7.6.2.1.1: voxel (i, j) of a frame lies at position + i * (column spacing) * row
 * direction + j * (row spacing) * column direction. Frames are ordered along the normal: the cross product of
 * row and column direction. */
#include "volume/formats/dicom/stack.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/context.h"
#include "core/memory.h"
#include "text/plain.h"

/* A frame and its coordinate along the normal. */
typedef struct placed_frame {
  const hl_dicom_frame *frame;
  double distance;
} placed_frame;

typedef struct sorting {
  const hl_dicom_set *set;
  const char *path;
  placed_frame *frames; /* owned; [count] */
  size_t count;
  vec3 row, column, normal;
  bool has_positions;
  double tolerance; /* two frames lie at the same position if their distance is at most the tolerance */
  double *places;   /* owned; [place_count]: the frames' positions along the normal */
  size_t place_count;
} sorting;

static const hl_dicom_file *file_of(const sorting *s, const hl_dicom_frame *frame) {
  return &s->set->files[frame->file];
}

static void warn(const sorting *s, const char *text) {
  hl_log(s->set->context, HL_LOG_WARNING, "%s: %s", s->path, text);
}

/* ---- which frames belong together ---- */

static bool all_finite(const double *numbers, int count) {
  for (int n = 0; n < count; n++)
    if (!(fabs(numbers[n]) < 1e12)) return false;
  return true;
}

static bool same_grid(const sorting *s, const hl_dicom_frame *a, const hl_dicom_frame *b) {
  const double COSINE_TOLERANCE = 1e-3;
  const hl_dicom_pixels *p = &file_of(s, a)->pixels, *q = &file_of(s, b)->pixels;
  if (p->rows != q->rows || p->columns != q->columns || p->samples != q->samples || p->tiles != q->tiles ||
      p->has_palette != q->has_palette)
    return false;
  if (file_of(s, a)->is_localizer != file_of(s, b)->is_localizer) return false;
  bool known = all_finite(a->orientation, 6);
  if (known != all_finite(b->orientation, 6) || all_finite(a->position, 3) != all_finite(b->position, 3))
    return false;
  for (int n = 0; n < 6 && known; n++)
    if (fabs(a->orientation[n] - b->orientation[n]) > COSINE_TOLERANCE) return false;
  for (int n = 0; n < 2; n++)
    if (fabs(a->spacing[n] - b->spacing[n]) > 1e-3 * fabs(a->spacing[n])) return false;
  return true;
}

/* Keeps the largest set of frames of the same size and orientation. Localizers are left out, unless all
 * frames of the series are localizers. */
static hl_status keep_majority(sorting *s, hl_error *error) {
  enum { CLASSES = 64 };
  size_t size[CLASSES] = {0}, classes = 0, best = 0;
  const hl_dicom_frame *first[CLASSES];
  unsigned char *class_of = hl_allocate(s->set->context, s->count, 1);
  if (class_of == NULL) return hl_fail_memory(error, s->count, "a list of frames");
  for (size_t n = 0; n < s->count; n++) {
    size_t c = 0;
    while (c < classes && !same_grid(s, first[c], s->frames[n].frame)) c++;
    if (c == classes && classes < CLASSES) first[classes++] = s->frames[n].frame;
    class_of[n] = (unsigned char)c;
    if (c < CLASSES) size[c]++;
  }
  for (size_t c = 1; c < classes; c++) {
    bool worse = file_of(s, first[c])->is_localizer && !file_of(s, first[best])->is_localizer;
    bool better = !file_of(s, first[c])->is_localizer && file_of(s, first[best])->is_localizer;
    if (better || (!worse && size[c] > size[best])) best = c;
  }
  size_t kept = 0, all = s->count;
  for (size_t n = 0; n < all; n++)
    if (class_of[n] == best) s->frames[kept++] = s->frames[n];
  s->count = kept;
  hl_release(s->set->context, class_of);
  if (kept < all)
    hl_log(s->set->context, HL_LOG_WARNING,
           "%s: %zu of %zu slices are left out: localizers, or of another size or orientation than the rest",
           s->path, all - kept, all);
  return HL_OK;
}

/* ---- order and positions of slices ---- */

/* Compares two numbers; NaN comes first. */
static int compare(double a, double b) {
  if (isnan(a) || isnan(b)) return isnan(b) - isnan(a);
  return a < b ? -1 : a > b;
}

/* Compares two frames at the same position, to find the order of the volumes to which they belong. The
 * attributes that differ between volumes are compared in turn, the most reliable one first. */
static int by_volume(const hl_dicom_frame *a, const hl_dicom_frame *b) {
  const double of_a[] = {a->temporal,     a->echo,         a->b_value,   a->diffusion[0],
                         a->diffusion[1], a->diffusion[2], a->inversion, a->flip,
                         a->trigger,      a->segment,      a->kind,      a->acquisition,
                         a->time,         a->instance,     a->file,      a->index};
  const double of_b[] = {b->temporal,     b->echo,         b->b_value,   b->diffusion[0],
                         b->diffusion[1], b->diffusion[2], b->inversion, b->flip,
                         b->trigger,      b->segment,      b->kind,      b->acquisition,
                         b->time,         b->instance,     b->file,      b->index};
  for (size_t n = 0; n < sizeof of_a / sizeof *of_a; n++) {
    int order = compare(of_a[n], of_b[n]);
    if (order != 0) return order;
  }
  return 0;
}

static int by_distance(const void *a, const void *b) {
  const placed_frame *x = a, *y = b;
  int order = compare(x->distance, y->distance);
  return order != 0 ? order : by_volume(x->frame, y->frame);
}

static int by_instance(const void *a, const void *b) {
  const hl_dicom_frame *x = ((const placed_frame *)a)->frame, *y = ((const placed_frame *)b)->frame;
  int order = compare(x->instance, y->instance);
  return order != 0 ? order : by_volume(x, y);
}

static int by_location(const void *a, const void *b) {
  const hl_dicom_frame *x = ((const placed_frame *)a)->frame, *y = ((const placed_frame *)b)->frame;
  int order = compare(x->location, y->location);
  return order != 0 ? order : by_volume(x, y);
}

static double pixel_spacing(const hl_dicom_frame *frame, int which) {
  return frame->spacing[which] > 0 && isfinite(frame->spacing[which]) ? frame->spacing[which] : 1;
}

/* The distance between slices as the file states it. The stated distance is used if the series has a single
 * slice, or if positions are missing. */
static double stated_spacing(const sorting *s, bool *known) {
  const hl_dicom_file *file = file_of(s, s->frames[0].frame);
  *known = true;
  if (file->slice_spacing != 0 && isfinite(file->slice_spacing)) return fabs(file->slice_spacing);
  if (file->thickness > 0 && isfinite(file->thickness)) return file->thickness;
  *known = false;
  return pixel_spacing(s->frames[0].frame, 0);
}

/* The axis of the patient along which the positions spread over the longest distance. */
static int widest_axis(const sorting *s) {
  double low[3], high[3];
  int widest = 2;
  for (int axis = 0; axis < 3; axis++) {
    low[axis] = high[axis] = s->frames[0].frame->position[axis];
    for (size_t n = 1; n < s->count; n++) {
      low[axis] = fmin(low[axis], s->frames[n].frame->position[axis]);
      high[axis] = fmax(high[axis], s->frames[n].frame->position[axis]);
    }
  }
  for (int axis = 0; axis < 2; axis++)
    if (high[axis] - low[axis] > high[widest] - low[widest]) widest = axis;
  return widest;
}

/* Chooses an orientation for slices that state none. Slices without an orientation are assumed to be
 * perpendicular to the patient's axis along which they follow each other. The rows of sagittal slices run
 * from front to back, the rows of coronal slices from right to left, and the columns of sagittal and coronal
 * slices from head to feet. */
static void assume_axes(sorting *s) {
  static const vec3 rows[3] = {{0, 1, 0}, {1, 0, 0}, {1, 0, 0}},
                    columns[3] = {{0, 0, -1}, {0, 0, -1}, {0, 1, 0}};
  static const char *const names[3] = {"sagittal", "coronal", "axial"};
  int axis = widest_axis(s);
  s->row = rows[axis];
  s->column = columns[axis];
  hl_log(s->set->context, HL_LOG_WARNING, "%s: the slices tell no orientation: they are taken for %s ones",
         s->path, names[axis]);
}

static void find_axes(sorting *s) {
  const hl_dicom_frame *frame = s->frames[0].frame;
  s->row = (vec3){1, 0, 0};
  s->column = (vec3){0, 1, 0};
  s->has_positions = all_finite(frame->position, 3);
  vec3 row = vec3_of(frame->orientation), column = vec3_of(frame->orientation + 3);
  bool oriented = all_finite(frame->orientation, 6) && vec3_length(vec3_cross(row, column)) > 0.1;
  if (oriented) {
    s->row = vec3_normalise(row);
    s->column = vec3_normalise(column);
  } else if (s->has_positions) {
    assume_axes(s);
  }
  s->normal = vec3_normalise(vec3_cross(s->row, s->column));
  if (file_of(s, frame)->frames.is_backwards) s->normal = vec3_scale(s->normal, -1);
}

/* Returns whether all frames state their coordinate along the normal, and these coordinates differ. */
static bool have_locations(const sorting *s) {
  bool differ = false;
  for (size_t n = 0; n < s->count; n++) {
    if (!all_finite(&s->frames[n].frame->location, 1)) return false;
    differ = differ || s->frames[n].frame->location != s->frames[0].frame->location;
  }
  return differ;
}

/* Returns whether all of several frames have the same position. */
static bool all_at_one_place(const sorting *s) {
  for (size_t n = 1; n < s->count; n++)
    for (int axis = 0; axis < 3; axis++)
      if (s->frames[n].frame->position[axis] != s->frames[0].frame->position[axis]) return false;
  return s->count > 1;
}

/* Sorts the frames by their positions. If positions are missing or all equal, sorts the frames by their
 * stated locations; if locations are missing too, sorts the frames by their numbers. */
static void sort(sorting *s) {
  bool known;
  if (s->has_positions && !(all_at_one_place(s) && have_locations(s))) {
    for (size_t n = 0; n < s->count; n++)
      s->frames[n].distance = vec3_dot(vec3_of(s->frames[n].frame->position), s->normal);
    qsort(s->frames, s->count, sizeof *s->frames, by_distance);
    s->tolerance = 0.01 * fmin(pixel_spacing(s->frames[0].frame, 0), pixel_spacing(s->frames[0].frame, 1));
    return;
  }
  s->has_positions = false;
  if (have_locations(s)) {
    qsort(s->frames, s->count, sizeof *s->frames, by_location);
    for (size_t n = 0; n < s->count; n++) s->frames[n].distance = s->frames[n].frame->location;
    s->tolerance = 0.01 * fmin(pixel_spacing(s->frames[0].frame, 0), pixel_spacing(s->frames[0].frame, 1));
    warn(s,
         "the slices tell no positions: their order and distance are those of their locations "
         "(SliceLocation)");
    return;
  }
  qsort(s->frames, s->count, sizeof *s->frames, by_instance);
  double step = stated_spacing(s, &known);
  size_t place = 0;
  for (size_t n = 0; n < s->count; n++) {
    const hl_dicom_frame *frame = s->frames[n].frame;
    bool same = n > 0 && file_of(s, frame)->frames.are_times && frame->file == s->frames[n - 1].frame->file;
    if (n > 0 && !same) place++;
    s->frames[n].distance = (double)place * step;
  }
  s->tolerance = step / 100;
  if (place > 0)
    hl_log(s->set->context, HL_LOG_WARNING,
           "%s: the slices tell no positions: they are ordered by their numbers, %g%s apart", s->path, step,
           known ? " mm" : " (a pixel's width)");
}

/* The index after the last frame that lies at the same position as frame `begin`. */
static size_t end_of_place(const sorting *s, size_t begin) {
  size_t end = begin + 1;
  while (end < s->count && s->frames[end].distance - s->frames[begin].distance <= s->tolerance) end++;
  return end;
}

/* The most common number of frames at one position. */
static size_t usual_count(const sorting *s) {
  enum { MOST = 4096 };
  static const size_t none = 1;
  size_t best = 0, usual = none;
  uint32_t *places_of = hl_allocate_zeroed(s->set->context, MOST, sizeof *places_of);
  if (places_of == NULL) return 0;
  for (size_t begin = 0, end; begin < s->count; begin = end) {
    end = end_of_place(s, begin);
    if (end - begin < MOST) places_of[end - begin]++;
    if (end - begin >= MOST && s->count == end - begin) usual = end - begin;
  }
  for (size_t n = 1; n < MOST; n++)
    if (places_of[n] > best) {
      best = places_of[n];
      usual = n;
    }
  hl_release(s->set->context, places_of);
  return usual;
}

static int by_volume_alone(const void *a, const void *b) {
  return by_volume(((const placed_frame *)a)->frame, ((const placed_frame *)b)->frame);
}

/* Makes the stack's list of the frames at each position. Most positions have the same number of frames.
 * Positions with fewer frames are left out. At positions with more frames, the surplus frames are left
 * out. */
static hl_status gather_places(sorting *s, hl_dicom_stack *stack, hl_error *error) {
  size_t times = usual_count(s), doubled = 0, incomplete = 0;
  if (times == 0) return hl_fail_memory(error, 1 << 14, "a list of slices");
  stack->times = times;
  stack->frames = hl_allocate(s->set->context, s->count, sizeof(hl_dicom_frame *));
  s->places = hl_allocate(s->set->context, s->count, sizeof *s->places);
  if (stack->frames == NULL || s->places == NULL)
    return hl_fail_memory(error, s->count * 2 * sizeof *s->places, "a list of slices");
  for (size_t begin = 0, end; begin < s->count; begin = end) {
    end = end_of_place(s, begin);
    if (end - begin < times) {
      incomplete += end - begin;
      continue;
    }
    qsort(s->frames + begin, end - begin, sizeof *s->frames, by_volume_alone);
    doubled += end - begin - times;
    for (size_t t = 0; t < times; t++) stack->frames[s->place_count * times + t] = s->frames[begin + t].frame;
    s->places[s->place_count++] = s->frames[begin].distance;
  }
  stack->place_count = s->place_count;
  if (doubled > 0)
    hl_log(s->set->context, HL_LOG_WARNING,
           "%s: %zu slices lie where others are: the first of each is taken, the rest left out", s->path,
           doubled);
  if (incomplete > 0)
    hl_log(s->set->context, HL_LOG_WARNING,
           "%s: %zu slices lie where other slices of their %zu volumes are missing: they are left out",
           s->path, incomplete, times);
  return HL_OK;
}

/* Makes a segmentation's list of the frames at each position, with one frame for each segment. */
static hl_status gather_segments(sorting *s, hl_dicom_stack *stack, hl_error *error) {
  const hl_dicom_segments *segments = &file_of(s, s->frames[0].frame)->segments;
  size_t unknown = 0, doubled = 0, count;
  if (__builtin_mul_overflow(s->count, segments->count, &count) || count > (size_t)1 << 27)
    return hl_fail(error, HL_ERROR_UNSUPPORTED,
                   "%s: %zu frames of %zu segments are too many: export some of them alone", s->path,
                   s->count, segments->count);
  stack->segments = segments;
  stack->times = segments->count;
  stack->frames = hl_allocate_zeroed(s->set->context, count, sizeof(hl_dicom_frame *));
  s->places = hl_allocate(s->set->context, s->count, sizeof *s->places);
  if (stack->frames == NULL || s->places == NULL)
    return hl_fail_memory(error, (count + s->count) * sizeof *s->places, "a list of slices");
  for (size_t begin = 0, end; begin < s->count; begin = end) {
    end = end_of_place(s, begin);
    const hl_dicom_frame **places = stack->frames + s->place_count * stack->times;
    for (size_t n = begin; n < end; n++) {
      size_t segment = hl_dicom_segment_of(segments, s->frames[n].frame->segment);
      unknown += segment == SIZE_MAX;
      doubled += segment != SIZE_MAX && places[segment] != NULL;
      if (segment != SIZE_MAX && places[segment] == NULL) places[segment] = s->frames[n].frame;
    }
    bool any = false;
    for (size_t n = 0; n < stack->times; n++) any = any || places[n] != NULL;
    if (any) s->places[s->place_count++] = s->frames[begin].distance;
  }
  stack->place_count = s->place_count;
  if (s->place_count == 0)
    return hl_fail(error, HL_ERROR_INPUT, "%s: not one frame shows a segment that the file lists", s->path);
  if (unknown + doubled > 0)
    hl_log(s->set->context, HL_LOG_WARNING,
           "%s: %zu frames show a segment that is not listed, and %zu frames a segment that another frame "
           "shows: "
           "they are left out",
           s->path, unknown, doubled);
  return HL_OK;
}

/* ---- even spacing ---- */

static int compare_doubles(const void *a, const void *b) {
  return compare(*(const double *)a, *(const double *)b);
}

/* The median distance between neighbouring positions; 0 if memory is short. */
static double median_step(const sorting *s) {
  size_t count = s->place_count - 1;
  double *steps = hl_allocate(s->set->context, count, sizeof *steps), median;
  if (steps == NULL) return 0;
  for (size_t n = 0; n < count; n++) steps[n] = s->places[n + 1] - s->places[n];
  qsort(steps, count, sizeof *steps, compare_doubles);
  median = steps[count / 2];
  hl_release(s->set->context, steps);
  return median;
}

/* Returns whether positions are evenly spaced, apart from missing ones: the distance from the first position
 * to each other position is a whole multiple of one step. step: the step, approximately. *slices: set to the
 * number of slices without gaps. */
static bool is_even(const sorting *s, double step, size_t *slices) {
  const double TOLERANCE = 0.05; /* as a fraction of a step */
  double span = s->places[s->place_count - 1] - s->places[0], steps = 0;
  for (size_t n = 0; n + 1 < s->place_count; n++)
    steps += fmax(1, floor((s->places[n + 1] - s->places[n]) / step + 0.5));
  if (steps > HL_BUNDLE_FILES_MOST) return false;
  for (size_t n = 0; n < s->place_count; n++) {
    double at = (s->places[n] - s->places[0]) / span * steps;
    if (fabs(at - floor(at + 0.5)) > TOLERANCE) return false;
  }
  *slices = (size_t)steps + 1;
  return true;
}

/* A slice between two positions is interpolated only if the distance of the two positions is at most
 * WIDEST_FILLED steps. Otherwise they are empty. */
#define WIDEST_FILLED 3.5

/* Places slices at even distances from the first to the last position. In segmentations, slices between
 * positions stay empty, because a segment is absent from a position at which it has no frame. */
static void spread(const sorting *s, size_t count, bool snap, hl_dicom_stack *stack) {
  double first = s->places[0], span = s->places[s->place_count - 1] - first;
  for (size_t n = 0, place = 0; n < count; n++) {
    double at = count > 1 ? first + span * (double)n / (double)(count - 1) : first;
    double step = count > 1 ? span / (double)(count - 1) : 1, near = (snap ? 0.1 : 0.001) * step;
    while (place + 1 < s->place_count && s->places[place + 1] <= at + near) place++;
    double offset = at - s->places[place];
    bool exact = offset <= near || place + 1 == s->place_count;
    double gap = exact ? 0 : s->places[place + 1] - s->places[place];
    bool empty = gap > WIDEST_FILLED * step || (!exact && stack->segments != NULL);
    stack->slices[n] = (hl_dicom_slice){place, exact || empty ? 0 : offset / gap, empty};
    stack->empty_count += empty;
  }
}

/* Tells the user how the slices without a frame in the file were made. count: the number of all slices. */
static void tell_spacing(const sorting *s, const hl_dicom_stack *stack, bool even, size_t count) {
  char text[300], holes[100] = "";
  double step = count > 1 ? (s->places[s->place_count - 1] - s->places[0]) / (double)(count - 1) : 0;
  size_t filled = 0;
  for (size_t n = 0; n < count; n++) filled += stack->slices[n].weight > 0;
  if (stack->segments != NULL) return;
  if (stack->empty_count > 0)
    snprintf(holes, sizeof holes, "%s%zu slices in wider holes are left empty",
             even && filled == 0 ? "" : "; ", stack->empty_count);
  if (!even)
    snprintf(text, sizeof text,
             "the slices are not evenly spaced: %zu slices, %.4g mm apart, are interpolated from the %zu%s",
             count, step, s->place_count, holes);
  else if (filled > 0)
    snprintf(text, sizeof text,
             "%zu of %zu slices are missing: they are interpolated from their neighbours%s", filled, count,
             holes);
  else snprintf(text, sizeof text, "slices are missing: %s", holes);
  if (!even || filled > 0 || stack->empty_count > 0) warn(s, text);
}

static hl_status space_evenly(sorting *s, hl_dicom_stack *stack, hl_error *error) {
  enum { TIMES_MORE = 4 };
  size_t count = s->place_count;
  bool even = true;
  if (count > 2) {
    double step = median_step(s), span = s->places[count - 1] - s->places[0];
    if (!(step > 0)) return hl_fail_memory(error, count * sizeof step, "distances of slices");
    even = is_even(s, step, &count) && count <= TIMES_MORE * s->place_count + 16;
    if (!even) {
      count = (size_t)fmin(span / step + 1.5, (double)(TIMES_MORE * s->place_count));
      if (count < 2) count = 2;
    }
  }
  stack->slices = hl_allocate(s->set->context, count, sizeof *stack->slices);
  if (stack->slices == NULL) return hl_fail_memory(error, count * sizeof *stack->slices, "a list of slices");
  stack->grid.dimensions[2] = count;
  spread(s, count, even, stack);
  tell_spacing(s, stack, even, count);
  return HL_OK;
}

/* ---- the grid ---- */

static void put(vec3 v, double to[3]) { to[0] = v.x, to[1] = v.y, to[2] = v.z; }

/* The first frame at a position. The first frame's position is used for all frames at the position. */
static const hl_dicom_frame *frame_of_place(const hl_dicom_stack *stack, size_t place) {
  const hl_dicom_frame **frames = stack->frames + place * stack->times;
  size_t n = 0;
  while (n + 1 < stack->times && frames[n] == NULL) n++;
  return frames[n];
}

/* Warns if positions do not lie on a straight line from the first to the last position. */
static void check_line(const sorting *s, const hl_dicom_stack *stack) {
  size_t last = s->place_count - 1;
  double span = s->places[last] - s->places[0], worst = 0;
  double pixel = fmin(pixel_spacing(frame_of_place(stack, 0), 0), pixel_spacing(frame_of_place(stack, 0), 1));
  vec3 first = vec3_of(frame_of_place(stack, 0)->position);
  vec3 way = vec3_subtract(vec3_of(frame_of_place(stack, last)->position), first);
  for (size_t n = 1; n < last; n++) {
    vec3 there = vec3_add(first, vec3_scale(way, (s->places[n] - s->places[0]) / span));
    worst = fmax(worst, vec3_length(vec3_subtract(vec3_of(frame_of_place(stack, n)->position), there)));
  }
  if (worst <= pixel) return;
  hl_log(s->set->context, HL_LOG_WARNING,
         "%s: slices are shifted sideways by up to %.4g mm from the line between the first and the last: "
         "they are shown on that line",
         s->path, worst);
}

static void make_grid(const sorting *s, hl_dicom_stack *stack) {
  hl_volume_description *grid = &stack->grid;
  const hl_dicom_frame *first = frame_of_place(stack, 0);
  const hl_dicom_pixels *pixels = &file_of(s, first)->pixels;
  size_t steps = grid->dimensions[2] - 1;
  bool known;
  grid->dimensions[0] = hl_dicom_slice_columns(pixels);
  grid->dimensions[1] = hl_dicom_slice_rows(pixels);
  put(vec3_scale(s->row, pixel_spacing(first, 1)), grid->axis[0]);
  put(vec3_scale(s->column, pixel_spacing(first, 0)), grid->axis[1]);
  if (s->has_positions) {
    memcpy(grid->origin, first->position, sizeof grid->origin);
    grid->space = file_of(s, first)->is_volume_space ? HL_SPACE_UNKNOWN : HL_SPACE_LPS;
  }
  if (steps == 0) {
    put(vec3_scale(s->normal, stated_spacing(s, &known)), grid->axis[2]);
    return;
  }
  vec3 way = vec3_scale(s->normal, s->places[s->place_count - 1] - s->places[0]);
  if (s->has_positions)
    way = vec3_subtract(vec3_of(frame_of_place(stack, s->place_count - 1)->position),
                        vec3_of(first->position));
  put(vec3_scale(way, 1 / (double)steps), grid->axis[2]);
  if (s->has_positions) check_line(s, stack);
}

static hl_status collect(sorting *s, size_t series, hl_error *error) {
  const hl_dicom_set *set = s->set;
  s->frames = hl_allocate(set->context, set->series[series].frames, sizeof *s->frames);
  if (s->frames == NULL)
    return hl_fail_memory(error, set->series[series].frames * sizeof *s->frames, "a list of frames");
  for (size_t n = 0; n < set->frame_count; n++)
    if (set->files[set->frames[n].file].series == series)
      s->frames[s->count++] = (placed_frame){&set->frames[n], 0};
  return HL_OK;
}

hl_status hl_dicom_stack_make(const hl_dicom_set *set, size_t series, hl_dicom_stack *stack,
                              hl_error *error) {
  sorting s = {.set = set, .path = set->bundle->path};
  *stack = (hl_dicom_stack){.context = set->context};
  hl_volume_description_defaults(&stack->grid);
  hl_status status = collect(&s, series, error);
  if (status == HL_OK) status = keep_majority(&s, error);
  if (status == HL_OK) {
    find_axes(&s);
    sort(&s);
    hl_dicom_segment_kind kind = file_of(&s, s.frames[0].frame)->segments.kind;
    bool by_segments = kind == HL_DICOM_BINARY || kind == HL_DICOM_FRACTIONAL;
    status = by_segments && file_of(&s, s.frames[0].frame)->segments.count > 0
                 ? gather_segments(&s, stack, error)
                 : gather_places(&s, stack, error);
  }
  if (status == HL_OK) status = space_evenly(&s, stack, error);
  if (status == HL_OK) make_grid(&s, stack);
  hl_release(set->context, s.frames);
  hl_release(set->context, s.places);
  return status;
}

void hl_dicom_stack_release(hl_dicom_stack *stack) {
  hl_release(stack->context, stack->frames);
  hl_release(stack->context, stack->slices);
}
