/* shadow/shadow_method.h - declares the interface of a shadow method.
 *
 * A method advances the shadow buffer of one light in lock-step with the picture. Each method is a table of
 * functions in a folder of its own, src/shadow_NAME/. The file scene/soft_methods.h lists the methods of soft
 * shadows. The sweep calls, for each light that casts shadows:
 *
 *     plan                once: chooses where the buffer lies, how fine it is, how it is read
 *     check               once: refuses buffers that are too large
 *     lay_out             twice: counts the memory for the estimate, then hands it out
 *     begin               once: initialises the memory; the buffer holds full light
 *     for each sheet k, for the slab between sheets k - 1 and k:
 *       before_shading      prepares the look-ups of the picture's slab
 *       before_slab         prepares the slab's compositing into the buffer
 *       for each tile       find_lit and before_tile before the tile is composited, after_tile if it absorbed
 *       advance             brings the buffer to sheet k
 *     end                 once, after a failure too
 *
 * A method without `advance`, or with `advances`, can be run in stretches of several slabs. First,
 * before_shading and before_slab are called for all slabs of a stretch. After these calls, each tile is
 * composited through all slabs of the stretch, one tile after the other. At the end of the stretch, `advance`
 * is called. The picture's slabs may be shaded later, from the planes that the buffer keeps. In a stretch,
 * `advance` changes the buffer at the last slab at most.
 *
 * A function that a method does not need is null. */
#ifndef HL_SHADOW_SHADOW_METHOD_H
#define HL_SHADOW_SHADOW_METHOD_H

#include "core/light_exchange.h"
#include "core/memory.h"
#include "light/light_emission.h"
#include "light/light_extent.h"
#include "scene/soft_methods.h"
#include "shadow/blur.h"
#include "shadow/shadow_buffer.h"

/* The functions for shadows of which each instruction set has a compiled version. A method that has such
 * functions defines their table in its own folder. */
typedef struct shadow_functions {
  attenuate_tile_function *attenuate;
  lit_blocks_function *lit_blocks;
  blur_functions blur;
  const struct cascade_functions *cascade;    /* see shadow_cascade/cascade_field.h */
  const struct sublight_functions *sublights; /* see shadow_sublights/sublight_field.h */
} shadow_functions;

/* The context, threads and functions with which a back end (the processors or a device) makes shadows. */
typedef struct shadow_means {
  hl_pool *pool;
  hl_reserve *reserve; /* lends memory blocks for the time of one sweep */
  const shadow_functions *functions;
} shadow_means;

/* The input of a shadow method: one light of one sweep. The struct borrows all that its pointers point to,
 * which must outlive the method's shadow. */
typedef struct shadow_setup {
  hl_context *context;
  const hl_render_settings *settings;
  const light_source *source;
  light_emission *emission; /* the light's emission image; null if all points of the light are equally bright.
                             * The method sets the positions of the image's cells */
  const sheet_stack *sheets;
  const view *eye;
  const light_exchange *exchange; /* exchanges light with the renderers of the other parts of a shared
                                   * picture; null if the picture is not shared, or its parts exchange
                                   * nothing */
  bool surfaces;                  /* whether some volume has surfaces; surfaces are lit by the light that
                                   * arrives at their outside */
  bool inner_corners;             /* whether boxes cut inner corners into some volume */
  int channels;                   /* number of channels of attenuation: 1 (grey) or 3 (R, G, B) */
  double voxel;                   /* the shortest edge of a voxel, frame units */
  double pixel;                   /* the edge of a picture's pixel, projected to the nearest content; frame
                                   * units */
  double middle_pixel;            /* the edge of a picture's pixel, projected to the middle of the content;
                                   * frame units */
  size_t picture_pixels;          /* number of pixels of the picture */
  const vec3 *seen; /* [seen_count]; corners of the content that the eye sees; frame space. The array is valid
                     * only in `plan` and `begin` */
  int seen_count;
  const vec3 *content; /* [content_count]; corners of all content, frame space */
  int content_count;
} shadow_setup;

/* A method's decisions about its buffer. */
typedef struct shadow_plan {
  shadow_extent extent; /* the region that the buffer covers */
  sheet_light seen;     /* the light as seen from the sheets; only for soft shadows */
  view view;            /* the buffer's view */
  bool cubic;           /* whether the buffer is read by cubic convolution */
  bool outside;         /* whether the buffer also keeps the light at the outside of surfaces */
  bool second;          /* whether the buffer has planes of the kind SHADOW_SECOND */
  int reach;            /* number of pixels beyond a tile that the method reads when it blurs */
  double spare;         /* number of pixels beyond a brick's projection that the picture's look-ups may
                         * read */
} shadow_plan;

/* Memory that a shadow method may keep from frame to frame. The renderer owns it. */
typedef struct shadow_memory {
  void *planes;    /* owned; [capacity]; the memory of the planes */
  size_t capacity; /* bytes of `planes` */
  bool zeros;      /* whether all bytes are zero; false while a method uses the memory, and after a cancelled
                    * frame */
} shadow_memory;

typedef struct shadow_method shadow_method;

/* One light's shadows in one sweep. */
typedef struct light_shadow {
  const shadow_method *method; /* the method that makes the shadows; null if the light casts no shadows, or
                                * the eye sees nothing */
  shadow_setup setup;
  shadow_means means; /* valid after hl_light_shadow_begin() */
  shadow_plan plan;
  shadow_buffer *buffer;  /* borrowed from the renderer */
  shadow_lookup *lookups; /* owned; [the buffer's ring]; for each kept sheet, the data by which the picture
                           * looks up the light */
  const sublight_lookup *sublights; /* [sublight_count]; the data by which the picture looks up each
                                     * sub-light's buffer; the picture takes the mean of the sub-lights'
                                     * light */
  int sublight_count, sublight_tiles_x, sublight_tiles_y; /* set by `plan`; sublight_tiles_x,
                                                           * sublight_tiles_y: size in tiles of each
                                                           * sub-light's buffer */
  void *state;                                            /* owned; [method->state_bytes]; the method's own
                                                           * data */
  shadow_memory *kept;                                    /* borrowed from the renderer */
  void *passing;                                          /* memory that the reserve of `means` lends until
                                                           * the sweep ends */
  /* [tiles]; for each tile, the last slab at which this part of a shared picture needs the tile; 0 if this
   * part never needs the tile. Null if this part needs all tiles at all slabs. Borrowed; the pointer must be
   * set before the first slab */
  const int32_t *needed_until;
  const int32_t *sublights_until; /* [sublight_count][sublight_tiles_y][sublight_tiles_x]; the same numbers as
                                   * in needed_until, but for the tiles of the sub-lights' buffers; set only
                                   * if sub-lights stand for the light */
  const unsigned char *owned;     /* [tiles]; 1 for tiles whose light this part of a shared picture sends to
                                   * the other parts; null if this part sends no light */
} light_shadow;

/* A method's memory besides the buffer. */
typedef struct shadow_layouts {
  hl_layout kept;    /* the memory that is kept from frame to frame (shadow_memory) */
  hl_layout passing; /* the uninitialised memory that is used until the sweep ends */
} shadow_layouts;

struct shadow_method {
  const char *name;
  size_t state_bytes; /* the number of bytes of light_shadow.state, which are all zero before `plan` is
                       * called */
  /* the first slab that casts shadows of a near light, if the light lies within a slab. 0: the slab in which
   * the light lies casts shadows, but only its part beyond the light counts. 1: the next slab is the first
   * that casts shadows */
  int first_slab;
  /* The delay of a mesh's surfaces, in pixels of the buffer: a surface absorbs light only at this distance
   * behind itself (surface/late/lateness.h). The delay holds for bilinear look-ups, which read less than a
   * pixel to each side, so that with a delay of 1 pixel a flat surface does not darken itself. Methods that
   * blur by a pixel or more need a greater delay. */
  double surface_delay;
  double surface_rise; /* the number of pixels of the buffer by which a mesh's surfaces are moved towards the
                        * light */
  void (*plan)(light_shadow *shadow);
  hl_status (*check)(const light_shadow *shadow, hl_error *error);
  void (*lay_out)(light_shadow *shadow, shadow_layouts *layouts);
  hl_status (*begin)(light_shadow *shadow, hl_error *error);
  /* Prepares the look-ups of the picture in a slab. lookup: receives the data by which the light at the sheet
   * before the slab is looked up. */
  void (*before_shading)(light_shadow *shadow, int sheet, shadow_lookup *lookup);
  /* Prepares the job that composites a slab into the buffer: sets the members that are equal for all
   * tiles. */
  void (*before_slab)(light_shadow *shadow, int sheet, attenuate_job *job);
  /* Finds the lit blocks of a tile and stores them in buffer->tile_lit. Null if the sweep finds the lit
   * blocks itself. Two calls for the same tile never run at the same time. */
  void (*find_lit)(light_shadow *shadow, size_t tile);
  void (*before_tile)(const light_shadow *shadow, size_t tile, attenuate_job *job);
  void (*after_tile)(light_shadow *shadow, size_t tile);
  void (*advance)(light_shadow *shadow, const occupancy *occupancy, int sheet);
  /* Whether each part of a shared picture computes only the tiles that it needs (needed_until,
   * sublights_until). */
  bool divides;
  /* Raises the numbers of tiles in needed_until, [tiles], if pixels of needed tiles will depend on pixels of
   * these tiles. Null if no tile depends on other tiles. */
  void (*widen_needs)(light_shadow *shadow, int32_t *needed_until);
  /* Whether each part of a shared picture computes only the tiles that it needs (needed_until, owned), and
   * gets the light of the other tiles from the other parts (the setup's exchange). Each tile that any brick
   * touches is owned by one of the parts. This part needs the tile as long as bricks touch it. */
  bool exchanges;
  /* Returns whether `advance` changes anything at a sheet. Null if `advance` may change the buffer at every
   * sheet. */
  bool (*advances)(const light_shadow *shadow, int sheet);
  void (*end)(light_shadow *shadow);
};

/* Returns the method that makes a light's shadows; null if the light casts no shadows. The method follows
 * from the settings `shadows` and soft_method. */
const shadow_method *hl_shadow_method(const light_source *source);

/* ---- for the sweep ---- */

/* Chooses the shadow method of a light, and lets the method plan. Afterwards shadow->method is null if no
 * shadows are to be made. */
hl_status hl_light_shadow_plan(light_shadow *shadow, const shadow_setup *setup, hl_error *error);
/* Returns whether the planned method can be run in stretches of several slabs (see the head of this file). */
static inline bool hl_runs_in_stretches(const shadow_method *method) {
  return method->advance == NULL || method->advances != NULL;
}
/* The size of the shadow buffer of a light whose shadows are planned. ring: number of sheets that the buffer
 * keeps. The renderer owns the buffer. */
shadow_buffer_size hl_light_shadow_buffer_size(const light_shadow *shadow, int ring);
/* Counts the bytes of the memory that the method takes besides the buffer. Call this function after the
 * method has planned. */
shadow_layouts hl_light_shadow_count(light_shadow *shadow);
/* Begins the shadows of a light: copies the planned shadow, and hands out memory. `planned` does not change.
 * The renderer owns `buffer` and `memory`. */
hl_status hl_light_shadow_begin(light_shadow *shadow, const light_shadow *planned, const shadow_means *means,
                                int ring, shadow_buffer *buffer, shadow_memory *memory, hl_error *error);
/* Releases the memory of a planned or begun shadow. Call this function after a failure, too. The struct may
 * be all zeros. */
void hl_light_shadow_end(light_shadow *shadow);

/* ---- for methods ---- */

/* The edge of a buffer's pixel, in frame units, that suits the distance between sheets. cubic: whether the
 * buffer is read by cubic convolution, which allows larger pixels. */
double hl_shadow_pixel(const shadow_setup *setup, bool cubic);
/* Returns whether cubic convolution is the best way to read a hard shadow's buffer: whether the larger pixels
 * that cubic convolution allows do not exceed the greatest fraction of a voxel's edge. */
bool hl_cubic_is_better(const shadow_setup *setup);
/* Plans a buffer that is parallel to the sheets. The buffer covers the points that the eye sees, and the
 * penumbrae around these points. pixel: edge of a pixel; frame units. */
void hl_plan_soft(light_shadow *shadow, double pixel);
/* hl_sharp_pixel() and hl_blurred_pixel() give the edge of a buffer's pixel in frame units: hl_sharp_pixel()
 * for light that is looked up without a blur, hl_blurred_pixel() for light that the method blurs. */
double hl_sharp_pixel(const shadow_setup *setup, bool cubic);
double hl_blurred_pixel(const shadow_setup *setup, bool cubic);
/* The region that a shadow buffer covers so that it holds all content that the eye sees. pixel: the wanted
 * edge of a buffer's pixel; frame units. */
shadow_extent hl_extent_of_seen(const shadow_setup *setup, double pixel);

/* The height of the last sheet above the first sheet. */
static inline double hl_last_height(const sheet_stack *sheets) {
  return hl_sheet_height(sheets, sheets->count - 1);
}

/* The tables of the shadow methods; each table is in a folder of its own. */
extern const shadow_method hl_shadow_hard;
#define HL_SOFT_METHOD(value, name) extern const shadow_method hl_shadow_##name;
HL_SOFT_METHODS
#undef HL_SOFT_METHOD

#endif
