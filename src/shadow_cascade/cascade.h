/* shadow_cascade/cascade.h - makes soft shadows whose penumbrae have the right width, unlike the penumbrae of
 * the paper's method.
 *
 * Penumbrae. Positions and widths are measured on a plane parallel to the sheets, onto which everything is
 * projected from the light's centre. On this plane a slab at height o casts a penumbra of width w = omega(r)
 * - omega(o) onto a receiver at height r. For parallel light omega(z) is (L / D) z, where L / D is the width
 * of the disk of the light's directions on the plane at height 1. For near light, omega(z) is -L / Z, where L
 * is the light's width and Z the distance from the light.
 *
 * Absorbed light. The light that is absorbed on its way to a receiver is the sum of the light that each slab
 * before the receiver has absorbed: 1 - T(r) = sum over o of T(o) (1 - t(o)), where each term is blurred by
 * the width w of its own penumbra. T(o) is the light that reached slab o, and t(o) is the slab's
 * transmittance. Light counts only in the slab that absorbs it first, so a thick occluder does not count
 * twice.
 *
 * Groups. The absorbed light of slabs is kept in groups of slabs. Groups are thin near the receiver, and
 * thick far from the receiver: a group of level 0 or 1 holds one chunk of slabs, a group of level j > 1 holds
 * 2^(j-1) chunks. The sum of absorbed light begins with the farthest group. On the way from group o to the
 * next group o', the sum is blurred by the variance (w(o)^2 - w(o')^2) / 12, and the absorbed light of o' is
 * added. The variances add up, so that in the end each group is blurred by the variance of its own penumbra.
 * Far levels have coarser pixels, because their penumbrae are wide. The groups of far levels are summed less
 * often, because the widths of their penumbrae change slowly.
 *
 * Near matter. Slabs join the groups one chunk late. The slabs of the current chunk and of the chunk before
 * attenuate the buffer directly, without blur. The first reason is that the penumbrae of these slabs are at
 * most a few pixels wide. The second reason is that these slabs hold the matter of the receiver's own
 * surface, whose absorption a blur would spread over the surface. (Derived: for a receiver on a plane that
 * sees the whole light, the plane's matter that is more than a chunk away lies farther aside than the light's
 * rim reaches.) At each chunk's end the buffer is refilled from the sum. The buffer's second planes keep the
 * light of the filling before. In the course of a chunk, samples fade from the second planes to the buffer's
 * first planes, so that no line shows where a chunk ends. So each filling serves two chunks. The penumbrae of
 * a filling have the right width at the border between its two chunks, where the filling has its full weight.
 *
 * Haze. The sum above holds for solid matter, which absorbs light at its edges. Thin matter absorbs the
 * fraction F of every ray through it. The light that arrives at a receiver at height r comes along rays with
 * fixed directions. So thin matter at o absorbs F (1 - s) of the light on its way to r, and not F T(o). Here
 * s is the sum over the groups before o, blurred for the receiver at r. A group therefore turns s into G + F
 * + (1 - F) s, where G = T(o) (1 - t(o)) belongs to the group's solid matter, and F to the group's thin
 * matter (derived). Two groups can be joined to one with 1 - F = (1 - F1) (1 - F2); G + F follows from
 * applying one group after the other.
 *
 * Surfaces of meshes that let no light pass count as solid matter in full light and next to their edges.
 * Counting as solid matter is right where several edges lie one behind the other. Elsewhere such surfaces
 * have F = 1, so that no light is left behind the surfaces, whatever light the matter before them lets pass.
 *
 * The buffer's axes are the principal axes of the light as the sheets see it. Along each axis the light has a
 * width of its own, stored as a fraction of the greater width. */
#ifndef HL_SHADOW_CASCADE_CASCADE_H
#define HL_SHADOW_CASCADE_CASCADE_H

#include "core/pool.h"
#include "elementary/elementary.h"
#include "light/light_emission.h"
#include "light/light_extent.h"
#include "shadow/shadow_method.h"
#include "shadow_cascade/cascade_field.h"
#include "shadow_cascade/cascade_reads.h"

/* CASCADE_MARGIN: the number of pixels of zeros between two rows, and of rows of zeros between two planes.
 * Blurs may read these zeros. */
enum { CASCADE_LEVELS = 16, CASCADE_GROUPS = 7, CASCADE_FEW_GROUPS = 4, CASCADE_MARGIN = 48 };

/* Absorbed light in the pixels of a level, with a margin of zeros around them. The margin at the end of a row
 * is also the margin before the next row. Likewise, the margin after a field is also the margin before the
 * next field. */
typedef struct cascade_field {
  field_pixel *pixels;  /* pixel (0,0) of the field, in the level's memory; null if a device has the pixels */
  unsigned char *zeros; /* [tiles]; 1 where all pixels of the tile are zeros, so that passes skip the tile; a
                         * part of the level's flags */
  /* index of the field's pixel (0,0) in an array of the pixels of all levels, one level after the other */
  size_t place;
} cascade_field;

/* The light that a group's slabs have absorbed. */
typedef struct cascade_group {
  cascade_field absorbed[HL_CHANNELS]; /* the sum G + F of the paragraph "Haze" at the head of this file */
  cascade_field thin[HL_CHANNELS];     /* the fraction F of every ray that thin matter absorbs ("Haze" at
                                        * the head of the file) */
  /* the group's position, as omega ("Penumbrae" at the head of this file); pixels of the buffer */
  double omega;
  bool filled; /* whether any pixel of the group is not zero */
} cascade_group;

/* The blur of a column or a row of tiles. fraction: the variance of the penumbrae in this column or row,
 * divided by the variance where the light is widest. box: the box of the current blur. */
typedef struct cascade_box {
  double fraction;
  blur_box box;
} cascade_box;

typedef struct cascade_level {
  int scale; /* edge of this level's pixels, in pixels of the buffer */
  int tiles_x, tiles_y;
  size_t first; /* number of the pixels of all levels before this level */
  /* four numbers of pixels. stride: the pixels from row to row. plane: the pixels of one field with its
   * margin. origin: the pixels before a field's pixel (0,0). pixels: the pixels of all fields and of the
   * margin after them */
  size_t stride, plane, origin, pixels;
  cascade_group group[CASCADE_GROUPS]; /* the groups of this level, the oldest first */
  int count, capacity;
  double fraction[2], greatest_fraction; /* three numbers from the fractions in `boxes`: their mean along
                                          * rows, their mean along columns, and the greatest fraction */
  cascade_field sum[2][HL_CHANNELS];     /* two sums, made for recent receivers; each is the sum of all groups
                                          * from the farthest one to a group of this level */
  int newest;                            /* the index in `sum` of the sum that includes the newest group */
  /* whether the sum includes a group of this level; if not, the sum of the next farther level takes its place
   */
  bool filled;
  double sum_omega; /* omega of the newest group in the sum */
  double owed[2];   /* along rows and along columns: the surplus of the variance of the sum's blur over the
                     * wanted variance; in squared pixels of the buffer */
  bool renewed;     /* whether the sum must be made again */
  cascade_field scratch;              /* a field for a sum that comes from farther levels; level 0 has none */
  cascade_field mean[2][HL_CHANNELS]; /* only for lights with an emission image: the fields `absorbed` and
                                       * `thin` of one group, averaged over the step between taps */
  cascade_box *boxes;                 /* owned; [tiles_x + tiles_y]; the blur of each column of tiles, then
                                       * of each row of tiles */
  field_pixel *memory;                /* borrowed from the shadow_memory; null if a device has the pixels */
  size_t planes;
  unsigned char *flags; /* owned; the arrays `zeros` of the level's fields */
} cascade_level;

/* A part's exchange of messages with the renderers of the other parts of one picture. A message holds the
 * light of one tile (cascade_exchange.c). */
typedef struct cascade_exchange {
  const light_exchange *with; /* the renderers of the other parts; null if the picture is not shared */
  size_t slot_bytes;          /* bytes of a message */
  size_t slots;               /* the greatest number of messages that a part sends at once */
  light_post post;            /* the post that sends `outgoing` and receives `incoming` */
  /* owned; outgoing: [post.most], the messages of this part; incoming: [parts][post.most], the messages of
   * all parts */
  unsigned char *outgoing, *incoming;
  unsigned char *sends; /* owned; [tiles]; 1 for tiles whose light of the last chunk this part
                         * sends to the other parts */
  uint32_t count;       /* number of the tiles that are marked in `sends` */
  size_t tile;          /* the tile with which the next message begins the search for marked tiles */
  bool sent;            /* whether a post of the last chunk is under way */
} cascade_exchange;

typedef struct soft_cascade {
  bool begun; /* whether the cascade's memory may hold numbers other than zero */
  bool parallel;
  double rate; /* the rate at which penumbrae widen. For parallel light: omega per frame unit of height. For
                * near light: the light's width L, in units of the edge that the buffer's pixels have at
                * distance 1 */
  double light_height;
  double widest;                        /* the greater of the light's two widths along the buffer's axes */
  double least_fraction;                /* the smaller of the light's two widths, as a fraction of the
                                         * greater */
  const light_emission *emission;       /* the light's emission image; null if all points of the light are
                                         * equally bright, so that blurs use boxes */
  double slope_start[2], slope_step[2]; /* slope_start: the slope of the light's ray through the buffer's
                                         * corner; slope_step: the change of the slope from pixel to pixel */
  double chunk;                         /* length of the current chunk of slabs, measured in omega; pixels of
                                         * the buffer */
  double chunk_start;                   /* omega at the start of the current chunk */
  double shortest_chunk;                /* length of the shortest chunk of the sweep, measured in omega */
  double shrink;          /* the length of a chunk divided by -omega at the chunk's start; 0 if all chunks
                           * have the same length */
  double evened;          /* from this omega on, all chunks have the same length again; pixels */
  double lookup_variance; /* the variance by which look-ups of the buffer blur, in squared pixels */
  uint64_t chunks;        /* number of the chunks that have ended */
  int channels;
  int level_count; /* number of the levels that have memory */
  cascade_level level[CASCADE_LEVELS];
  cascade_field absorbed[HL_CHANNELS]; /* the absorbed light from which the buffer was filled last: one of the
                                        * sums of level 0 */
  /* pixel (0,0) of each channel, in the memory of level 0; 1 minus the light at the start of the current
   * chunk */
  float *absorbed_at_start[HL_CHANNELS];
  /* pixel (0,0) of each channel, in the memory of level 0; the sum, over the current chunk's slabs, of the
   * light that a slab absorbed times the slab's position */
  float *moment[HL_CHANNELS];
  unsigned char *refilled;   /* owned; [tiles]; for each tile, the bits REFILLED_BEFORE and REFILLED_NOW */
  unsigned char *touched;    /* owned; [tiles]; 1 where slabs of the current chunk have absorbed light */
  cascade_reads reads;       /* the tiles that slabs of the next chunk read */
  cascade_exchange exchange; /* the exchange of messages with the other parts of a shared picture */
} soft_cascade;

/* The threads and functions for passes over a cascade's fields. */
typedef struct cascade_crew {
  const struct cascade_works *works; /* the functions that make the passes (cascade_passes.h) */
  /* set if the processors make the passes: */
  hl_pool *pool;
  const cascade_functions *functions;
  const cascade_reads *reads;
  /* set if a device makes the passes: */
  void *device; /* the data of the functions in `works` */
} cascade_crew;

/* The functions of a shadow_method (shadow/shadow_method.h) that are in cascade_levels.c. */
void hl_cascade_plan(light_shadow *shadow);
void hl_cascade_lay_out(light_shadow *shadow, shadow_layouts *layouts);
hl_status hl_cascade_begin(light_shadow *shadow, hl_error *error);
void hl_cascade_end(light_shadow *shadow);
/* Begins a copy of a planned shadow whose pixels are in the memory of a device. The arrays that last until
 * the sweep ends are laid out; the buffer and the planes that are kept between frames are null. */
void hl_cascade_begin_elsewhere(light_shadow *shadow);

/* cascade_method.c */

/* The place of a slab among the chunks. */
typedef struct cascade_slab {
  float position; /* the slab's position in its chunk (attenuate_job.position) */
  float young;    /* the weight of the current chunk's light while samples fade to it (shadow_lookup.young) */
  int chunk;      /* number of the slab's chunk; the first chunk is 1 */
  bool ends;      /* whether the chunk ends at the sheet after the slab */
} cascade_slab;

/* Finds the chunk of each slab of a planned shadow. first: the first sheet at which a chunk may end. slabs:
 * [sheets]; slab k lies before sheet k. */
void hl_cascade_find_chunks(const light_shadow *planned, int first, cascade_slab *slabs);
/* Ends a chunk: adds its matter to the groups, sums the groups and refills the buffer. occupancy: which tiles
 * of the light's view hold anything. */
void hl_cascade_end_chunk(light_shadow *shadow, const occupancy *occupancy, int sheet,
                          const cascade_crew *crew);

/* cascade_exchange.c */
void hl_cascade_exchange_lay_out(soft_cascade *cascade, const light_exchange *with, shadow_layouts *layouts);
/* Begins to send messages to the other parts. The messages hold the pixels of the two groups at the ends of
 * the last chunk, in the tiles that this part owns and that the chunk has touched. */
void hl_cascade_exchange_send(soft_cascade *cascade, const unsigned char *owned);
/* Lets messages that are under way make progress. */
void hl_cascade_exchange_look(const soft_cascade *cascade);
/* Waits for the messages of the other parts, and stores the pixels of their tiles in the groups. Notes
 * whether the chunk has touched any tile of any part. Call this function before any code reads the groups.
 * The function does nothing if no messages are under way. */
void hl_cascade_exchange_receive(soft_cascade *cascade);

/* Converts a height to omega, the measure in which penumbrae widen evenly ("Penumbrae" at the head of this
 * file); pixels of the buffer. */
static inline double hl_cascade_omega(const soft_cascade *cascade, double height) {
  if (cascade->parallel) return cascade->rate * height;
  double distance = height - cascade->light_height;
  return distance > 0 ? -cascade->rate / distance : -INFINITY;
}

/* The value of omega after a number of further chunks. Derived: a chunk that begins at omega ends at omega (1
 * - shrink). All chunks that begin beyond the omega `evened` have the length of the chunk that begins at
 * `evened`. */
static inline double hl_cascade_chunks_on(const soft_cascade *cascade, double omega, double chunks) {
  if (!(cascade->shrink > 0)) return omega + cascade->chunk * chunks;
  if (omega < cascade->evened) {
    double shrinking = hl_ln(cascade->evened / omega) / hl_ln(1 - cascade->shrink);
    if (chunks <= shrinking) return omega * hl_pow(1 - cascade->shrink, chunks);
    omega = cascade->evened;
    chunks -= shrinking;
  }
  return omega - cascade->shrink * cascade->evened * chunks;
}

/* For a light with an emission image (cascade_emission.c): finds the absorbed light for receivers around
 * omega = receiver, and stores it in cascade->absorbed, in the tiles that are read. Returns false if no
 * matter is in the light's way. */
bool hl_cascade_pass_emission(soft_cascade *cascade, double receiver, const cascade_crew *crew);

#endif
