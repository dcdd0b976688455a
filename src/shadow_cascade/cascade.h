/* shadow_cascade/cascade.h - soft shadows whose penumbrae have the right width (beyond the paper).
 *
 * Penumbrae. Positions and widths are measured on a plane parallel to the sheets, onto which everything is
 * projected from the light's centre. On this plane a slab at height o casts a penumbra of width w = omega(r)
 * - omega(o) onto a receiver at height r. For parallel light omega(z) is (L / D) z, where L / D is the width
 * of the disk of the light's directions on the plane at height 1. For near light it is -L / Z, where L is the
 * light's width and Z the distance from the light.
 *
 * Absorbed light. The light that is absorbed on its way to a receiver is the sum of the light that each slab
 * before the receiver has absorbed: 1 - T(r) = sum over o of T(o) (1 - t(o)), each term blurred by its w.
 * T(o) is the light that reached slab o, t(o) the slab's transmittance. Light is counted only where it is
 * absorbed first, so a thick occluder is not counted twice.
 *
 * Groups. The absorbed light of slabs is kept in groups, which are thin near the receiver and thick far from
 * it: groups of levels 0 and 1 hold one chunk of slabs, those of level j hold 2^(j-1) chunks. From the
 * farthest group on, the sum is blurred by the variance (w(o)^2 - w(o')^2) / 12 on its way from group o to
 * the next group o', and the absorbed light of o' is added. The variances add up so that in the end each
 * group is blurred by the variance of its own penumbra. Far levels have coarser pixels, because their
 * penumbrae are wide. They are summed less often, because the widths of their penumbrae change slowly.
 *
 * Near matter. Slabs join the groups one chunk late. The slabs of the current chunk and of the chunk before
 * attenuate the buffer directly, without blur. There are two reasons. Their penumbrae are at most a few
 * pixels wide. And the matter of the receiver's own surface is among these slabs, which a blur would spread
 * over the surface. (Derived: for a receiver on a plane that sees the whole light, the plane's matter that is
 * more than a chunk away lies farther aside than the light's rim reaches.) At each chunk's end the buffer is
 * refilled from the sum. Its second planes keep the light of the filling before. In the course of a chunk
 * samples fade from the second planes to the buffer, so that no line shows where a chunk ends. So each
 * filling serves two chunks. Its penumbrae have the right width at the border between the two, where it
 * counts fully.
 *
 * Haze. The sum above holds for solid matter, which absorbs light at its edges. Thin matter absorbs the
 * fraction F of every ray through it. Rays towards r keep their directions. So of the light on its way to r
 * thin matter absorbs F (1 - s), and not F T(o), where s is the sum so far, blurred for o and r. A group
 * therefore turns s into G + F + (1 - F) s, where G = T(o) (1 - t(o)) belongs to its solid matter and F to
 * its thin matter (derived). Two groups can be joined to one with 1 - F = (1 - F1) (1 - F2); G + F follows
 * from applying one group after the other.
 *
 * Surfaces of meshes that let nothing pass count as solid matter in full light and next to their edges, which
 * is right where several edges lie one behind the other. Elsewhere they have F = 1, so that behind them no
 * light is left, whatever the matter before them lets pass.
 *
 * The buffer's axes are the principal axes of the light as the sheets see it. Along each axis the light has a
 * width of its own, stored as a fraction of the greater width. */
#ifndef HL_SHADOW_CASCADE_CASCADE_H
#define HL_SHADOW_CASCADE_CASCADE_H

#include "core/pool.h"
#include "light/light_emission.h"
#include "light/light_extent.h"
#include "shadow/shadow_method.h"
#include "shadow_cascade/cascade_field.h"
#include "shadow_cascade/cascade_reads.h"

/* CASCADE_MARGIN: pixels of zeros between rows, and rows of zeros between planes, which blurs may read. */
enum { CASCADE_LEVELS = 16, CASCADE_GROUPS = 7, CASCADE_FEW_GROUPS = 4, CASCADE_MARGIN = 48 };

/* Absorbed light over the pixels of a level, with a margin of zeros around them. The margin at the end of a
 * row is also the margin before the next row, and likewise between fields. */
typedef struct cascade_field {
  field_pixel *pixels;  /* pixel (0,0); in the level's memory */
  unsigned char *zeros; /* [tiles]; 1 where all pixels of the tile are zeros, so that work skips it; a part
                         * of the level's flags */
} cascade_field;

/* The light that a group's slabs have absorbed. */
typedef struct cascade_group {
  cascade_field absorbed[HL_CHANNELS]; /* G + F */
  cascade_field thin[HL_CHANNELS];     /* F */
  double omega;                        /* the group's position; pixels of the buffer */
  bool filled;                         /* not all zeros */
} cascade_group;

/* How a column or a row of tiles is blurred. fraction: the variance of its penumbrae as a fraction of the
 * variance where the light is widest. box: the box of the current blur. */
typedef struct cascade_box {
  double fraction;
  blur_box box;
} cascade_box;

typedef struct cascade_level {
  int scale; /* edge of this level's pixels, pixels of the buffer */
  int tiles_x, tiles_y;
  size_t stride, plane, origin, pixels; /* numbers of pixels. stride: from row to row; plane: of a field;
                                         * origin: before a field's pixel (0,0); pixels: of all fields and the
                                         * margin after them */
  cascade_group group[CASCADE_GROUPS];  /* oldest first */
  int count, capacity;
  double fraction[2], greatest_fraction; /* of `boxes`: the mean fraction along rows and along columns, and
                                          * the greatest fraction */
  cascade_field sum[2][HL_CHANNELS]; /* two sums of all groups from the farthest one to a group of this level;
                                      * each was made for a recent receiver */
  int newest;                        /* which of the two sums includes the newest group */
  bool filled;      /* the sum includes a group of this level; if not, the sum of the next farther level is
                     * used in its place */
  double sum_omega; /* omega of the newest group in the sum */
  double owed[2];   /* along rows and columns, the variance by which the sum has been blurred too much; in
                     * squared pixels of the buffer */
  bool renewed;     /* the sum must be made again */
  cascade_field scratch;              /* for sums from farther levels; not on level 0 */
  cascade_field mean[2][HL_CHANNELS]; /* for lights with an emission image: averages of one group's `absorbed`
                                       * and `thin` over the step between taps */
  cascade_box *boxes;                 /* owned; [tiles_x], then [tiles_y] */
  field_pixel *memory;                /* the shadow_memory's */
  size_t planes;
  unsigned char *flags; /* owned */
} cascade_level;

/* Messages between the renderers that make the parts of one picture. A message holds the light of one tile
 * (cascade_exchange.c). */
typedef struct cascade_exchange {
  const light_exchange *with;         /* null: nobody */
  size_t slot_bytes;                  /* of a message */
  size_t slots;                       /* messages of a post, at most */
  light_post post;                    /* of the next two */
  unsigned char *outgoing, *incoming; /* owned; [post.most]; [parts][post.most] */
  unsigned char *sends;               /* owned; [tiles]; 1 where this part sends the tile's light of the
                                       * last chunk to the other parts */
  uint32_t count;                     /* of these tiles */
  size_t tile;                        /* the next one to tell of */
  bool sent;                          /* a post of the last chunk is under way */
} cascade_exchange;

typedef struct soft_cascade {
  bool begun; /* its memory may hold numbers other than zero */
  bool parallel;
  double rate; /* the rate at which penumbrae widen: for parallel light, omega per frame unit of height; for
                * near light, L in units of the size that the buffer's pixels have at distance 1 */
  double light_height;
  double widest;                        /* the greater of the light's widths along the buffer's axes */
  double least_fraction;                /* the smaller width as a fraction of the greater */
  const light_emission *emission;       /* null: the light is even, and blurs are boxes */
  double slope_start[2], slope_step[2]; /* the slope of the light's rays at the buffer's corner, and the
                                         * change of the slope from one pixel to the next */
  double chunk;                         /* length of the current chunk in omega, pixels */
  double chunk_start;                   /* omega */
  double shortest_chunk;                /* of the sweep */
  double shrink; /* length of a chunk, as a fraction of -omega at the chunk's start; 0: all chunks have the
                  * same length */
  double evened; /* the omega, in pixels, from which on chunks are equally long again */
  double lookup_variance; /* variance by which look-ups blur the buffer, in squared pixels */
  uint64_t chunks;        /* finished */
  int channels;
  int level_count; /* levels with memory */
  cascade_level level[CASCADE_LEVELS];
  cascade_field absorbed[HL_CHANNELS];   /* the absorbed light with which the buffer was filled last; one of
                                          * level 0's sums */
  float *absorbed_at_start[HL_CHANNELS]; /* pixel (0,0) on level 0: 1 - the light at the start of the chunk */
  float *moment[HL_CHANNELS]; /* pixel (0,0) on level 0: the sum of the light that the chunk's slabs
                               * absorbed, each times the slab's position */
  unsigned char *refilled;    /* owned; [tiles]; REFILLED_BEFORE, REFILLED_NOW */
  unsigned char *touched;     /* owned; [tiles]; 1 where the chunk's slabs absorbed light */
  cascade_reads reads;        /* the tiles that the next chunk's slabs read */
  cascade_exchange exchange;  /* with the other parts of a shared picture */
} soft_cascade;

/* Data for every pass over a cascade's fields. */
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

/* cascade_exchange.c */
void hl_cascade_exchange_lay_out(soft_cascade *cascade, const light_exchange *with, shadow_layouts *layouts);
/* Begins to send messages to the other parts. They hold the pixels of the groups at the two ends of the last
 * chunk, for those tiles that this part owns and that the chunk has touched. */
void hl_cascade_exchange_send(soft_cascade *cascade, const unsigned char *owned);
/* Lets what is under way get on. */
void hl_cascade_exchange_look(const soft_cascade *cascade);
/* Waits for the messages of the other parts, stores the pixels of the others' tiles in the groups, and notes
 * whether the chunk has touched any tile of any part. Call it before anything reads the groups. It does
 * nothing where no messages are under way. */
void hl_cascade_exchange_receive(soft_cascade *cascade);

/* omega at a height. */
static inline double hl_cascade_omega(const soft_cascade *cascade, double height) {
  if (cascade->parallel) return cascade->rate * height;
  double distance = height - cascade->light_height;
  return distance > 0 ? -cascade->rate / distance : -INFINITY;
}

/* The value of omega after a number of further chunks. Derived: a chunk that begins at omega ends at omega (1
 * - shrink). All chunks that begin beyond `evened` have the length of a chunk that begins at `evened`. */
static inline double hl_cascade_chunks_on(const soft_cascade *cascade, double omega, double chunks) {
  if (!(cascade->shrink > 0)) return omega + cascade->chunk * chunks;
  if (omega < cascade->evened) {
    double shrinking = log(cascade->evened / omega) / log(1 - cascade->shrink);
    if (chunks <= shrinking) return omega * pow(1 - cascade->shrink, chunks);
    omega = cascade->evened;
    chunks -= shrinking;
  }
  return omega - cascade->shrink * cascade->evened * chunks;
}

/* Finds the absorbed light for receivers around omega = receiver, for a light with an emission image, and
 * stores it in cascade->absorbed in the tiles that are read (cascade_emission.c). False: nothing is in the
 * light's way. */
bool hl_cascade_pass_emission(soft_cascade *cascade, double receiver, const cascade_crew *crew);

#endif
