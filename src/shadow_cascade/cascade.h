/* shadow_cascade/cascade.h - soft shadows whose penumbrae have the right width (beyond the paper).
 *
 * Seen from the light's centre on a plane parallel to the sheets, an occluder at o and a receiver at r blur
 * each other by a width that is a difference, w = omega(r) - omega(o). What a receiver lacks is what every
 * slab before it took of the light that reached that slab: T(r) = 1 - sum over o of T(o) (1 - t(o)), blurred
 * by w. Each slab's share is counted where light first meets it, so that thick occluders darken once, and
 * sums may be blurred together: the slabs are kept in groups of doubling thickness, the nearest thin, the
 * farthest thick (those of levels 0 and 1 a chunk of slabs, of level j 2^(j-1) chunks), and from the farthest
 * group o on the sum is blurred by the variance (w(o)^2 - w(o')^2) / 12 on the way to the next group o'. The
 * variances telescope, and every group ends with the variance of its own penumbra. Far groups are kept
 * coarser (what is left of them is blurred wide) and renewed more rarely (their widths change slowly).
 *
 * Matter joins the groups a chunk late. What the slabs of a chunk and of the one before took is multiplied as
 * it is, sharp: within two chunks penumbrae are some pixels wide at most, and a surface's own matter is
 * there, which blurs would spread over the surface (derived: a plane's matter lies farther beside a receiver
 * than the light's rim reaches, by all of it that is more than a chunk away, where the plane sees the whole
 * light). At each chunk's end the buffer is refilled; its second planes hold what it was before, and
 * receivers fade from these to the new ones in the course of a chunk: no line shows where one ends. Each
 * filling serves two chunks, the more the closer to the end of the first, where its penumbrae are right.
 *
 * So solid matter is counted, which light meets at its edges. Haze takes a part F of every ray that comes
 * through it, and rays towards r keep their directions: of the light on its way to r, the sum s so far
 * blurred for o and r, it takes F (1 - s), not F times what reaches o from all the light. With G = T(o) (1 -
 * t(o)) of the solid part and F of the thin one, a group makes of s: G + F + (1 - F) s (derived); two of them
 * are one with 1 - F = (1 - F1) (1 - F2) and G + F likewise.
 *
 * omega: parallel light  (L / D) z, the disk of directions on a plane parallel to the sheets; else -L / Z.
 * The buffer's axes are those of the light as the sheets see it, and each has its own part of the width. */
#ifndef HL_SHADOW_CASCADE_CASCADE_H
#define HL_SHADOW_CASCADE_CASCADE_H

#include "core/pool.h"
#include "light/light_emission.h"
#include "light/light_extent.h"
#include "shadow/shadow_method.h"
#include "shadow_cascade/cascade_field.h"
#include "shadow_cascade/cascade_reads.h"

/* CASCADE_MARGIN: pixels of zeros between rows, and rows of them between planes, that blurs may read. */
enum { CASCADE_LEVELS = 16, CASCADE_GROUPS = 7, CASCADE_FEW_GROUPS = 4, CASCADE_MARGIN = 48 };

/* Absorbed light over the pixels of a level, zeros around them: what follows a row, or a field, is the margin
 * before the next. */
typedef struct cascade_field {
  field_pixel *pixels;  /* pixel (0,0); in the level's memory */
  unsigned char *zeros; /* [tiles]; 1 where the tile is all zeros: work skips it; in the level's flags */
} cascade_field;

/* What slabs around omega absorbed. */
typedef struct cascade_group {
  cascade_field absorbed[HL_CHANNELS]; /* G + F */
  cascade_field thin[HL_CHANNELS];     /* F */
  double omega;                        /* pixels of the buffer */
  bool filled;                         /* not all zeros */
} cascade_group;

/* A column or row of tiles: the part of the greatest variance that it has, and the box of the blur now
 * done. */
typedef struct cascade_box {
  double fraction;
  blur_box box;
} cascade_box;

typedef struct cascade_level {
  int scale; /* buffer pixels a pixel of this level */
  int tiles_x, tiles_y;
  size_t stride, plane, origin,
      pixels; /* of a row, a field, before its pixel (0,0), of all fields and the margin after them */
  cascade_group group[CASCADE_GROUPS]; /* oldest first */
  int count, capacity;
  double fraction[2], greatest_fraction; /* of boxes: means along rows and columns, and the greatest */
  cascade_field sum[2][HL_CHANNELS];     /* of all groups up to one of this level, for a recent receiver */
  int newest;                            /* which of sum is the newest group's */
  bool filled;      /* some group of this level is in sum; else see the next farther level */
  double sum_omega; /* of the newest group in sum */
  double owed[2]; /* what the sum is blurred too much along rows and columns, pixels of the buffer squared */
  bool renewed;   /* sum is to be found anew */
  cascade_field scratch;              /* of farther levels */
  cascade_field mean[2][HL_CHANNELS]; /* through an image: of one group's absorbed and thin light */
  cascade_box *boxes;                 /* owned; [tiles_x], then [tiles_y] */
  field_pixel *memory;                /* the shadow_memory's */
  size_t planes;
  unsigned char *flags; /* owned */
} cascade_level;

typedef struct soft_cascade {
  bool begun; /* its memory holds more than zeros */
  bool parallel;
  double rate; /* parallel: omega per height; else L in units of a pixel at distance 1 */
  double light_height;
  double widest;                        /* of the light's widths along the buffer's axes */
  double least_fraction;                /* the other of them, as a part of it */
  const light_emission *emission;       /* null: boxes will do */
  double slope_start[2], slope_step[2]; /* of the buffer's pixels, seen from the light: at its corner, and
                                           from one to the next */
  double chunk;                         /* omega of a chunk of slabs, pixels */
  double chunk_start;                   /* omega */
  double lookup_variance;               /* what look-ups blur, pixels squared */
  double slab;     /* the place of the slab now composited in the chunk, omega from its start */
  uint64_t chunks; /* finished */
  int channels;
  int level_count; /* levels with memory */
  cascade_level level[CASCADE_LEVELS];
  cascade_field
      absorbed[HL_CHANNELS]; /* what the buffer's last receivers lack, on level 0: one of its sums */
  float *absorbed_at_start[HL_CHANNELS]; /* pixel (0,0) on level 0: 1 - the light at the chunk's start */
  float *moment[HL_CHANNELS]; /* pixel (0,0) on level 0: what the chunk's slabs took, times their places */
  unsigned char *refilled;    /* owned; [tiles]; at which of the last two chunks' ends */
  unsigned char *touched;     /* owned; [tiles]; 1 where the chunk's slabs took light */
  cascade_reads reads;        /* by the next chunk's slabs */
} soft_cascade;

/* Who does a pass over a cascade's fields. */
typedef struct cascade_crew {
  hl_pool *pool;
  const cascade_functions *functions;
  const cascade_reads *reads;
} cascade_crew;

/* cascade_levels.c: as shadow_method has them. */
void hl_cascade_plan(light_shadow *shadow);
void hl_cascade_lay_out(light_shadow *shadow, shadow_layouts *layouts);
hl_status hl_cascade_begin(light_shadow *shadow, hl_error *error);
void hl_cascade_end(light_shadow *shadow);

/* Of a height. */
static inline double hl_cascade_omega(const soft_cascade *cascade, double height) {
  if (cascade->parallel) return cascade->rate * height;
  double distance = height - cascade->light_height;
  return distance > 0 ? -cascade->rate / distance : -INFINITY;
}

/* cascade_emission.c: what receivers around omega = receiver lack, through the light's image, in shade
 * where it is read; false if nothing is in the way. */
bool hl_cascade_pass_emission(soft_cascade *cascade, double receiver, const cascade_crew *crew);

#endif
