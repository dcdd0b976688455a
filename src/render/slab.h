/* render/slab.h - steps 12 to 16: gradient, classification, shadow look-up, illumination, compositing.
 *
 * The slab between two sheets is shaded. Along each ray the density is linear between the two sheets. The
 * gradient is found with the kernel's derivative, at the position where the slab's matter is seen. The shadow
 * buffer holds the light that reaches the first sheet. */
#ifndef HL_RENDER_SLAB_H
#define HL_RENDER_SLAB_H

#include "field/sky_field.h"
#include "light/light_caps.h"
#include "light/light_source.h"
#include "light/light_texture.h"
#include "light/phase_table.h"
#include "render/cut.h"
#include "scatter/scatter.h"
#include "shadow/attenuate.h"
#include "shadow/shadow_buffer.h"

struct surface_samples;

/* The colours of a volume's voxels, or of its mask. */
typedef struct voxel_colors {
  const unsigned char *voxels; /* owned by the volume or mask; [k][j][i][4]; the colours of voxels
                                * (volume/colors.h, label/mask.h); null if there are no colours */
  int32_t last[3];             /* the greatest index along i, j, k */
  int32_t step_bytes[3];       /* number of bytes from one voxel to the next along i, j, k */
  const float *decode;         /* [256]: the linear values of codes */
} voxel_colors;

typedef struct shade_volume {
  const classifier *classifier;
  const grid *grid;
  const kernel *kernel;
  int phong, visible, receives_shadow;
  int lit;     /* 0 if the volume is shaded flat, so that its colour does not depend on light */
  int even;    /* whether surfaces reflect all light that arrives, from any angle; set in the passes for a
                * light's shadow layer */
  float voxel; /* the smallest edge of a voxel; frame units */
  float ambient, diffuse, specular, shininess; /* ka kd ks n */
  float emission;                              /* the emission ke; 1 for a volume that is shaded flat */
  float cast[HL_CHANNELS];                     /* the extinction for lights divided by the extinction for the
                                                * eye, in each channel; if 0, the volume casts no shadow */
  float to_index[3][4], low[3], high[3];       /* maps frame space to index space; also the volume's box in
                                                * index space */
  int32_t face_cuts[3][2]; /* [axis][low, high]: -1 for a face of the volume's box that cuts visible matter,
                            * else 0 */
  int any_face;            /* whether some face of the box cuts visible matter */
  const float (*shown)[4]; /* [table entries]; only in a maximum projection: the rows of shown values
                            * (SHOWN_FROM and so on); else null */
  int rank;                /* among the visible volumes */
  float anisotropy;        /* g of the phase function */
  const phase_table *phase_once, *phase_twice; /* tables of the phase functions for g and for g^2; null if g
                                                * is 0, or if there is neither a sky nor a wide light */
  voxel_colors colors;                         /* colours that multiply the transfer function's colours */
  float albedo[3];                             /* the product of the medium's albedo and its colour */
  int absorbs;                                 /* whether some channel of the albedo is not 1 */
  int multiple;                                /* whether light that was scattered more than once lights the
                                                * volume */
  const shade_cut *cuts;                       /* [cut_count] */
  int cut_count, light_cut_count; /* cut_count: number of the cuts that remove matter from the eye's view.
                                   * light_cut_count: number of the cuts that remove matter from the lights'
                                   * views. It is the same number, or 0 if removed matter still casts
                                   * shadows */
  int cut_shading;                /* hl_cut_shading */
  int mask_faces;                 /* whether the faces that the mask makes in the matter are lit by their own
                                   * normals */
  voxel_colors tints;             /* the mask's colours, which are mixed with the matter's colours by the
                                   * weights of the mask's voxels */
  int object;                     /* the volume's number in the layer `object` */
} shade_volume;

/* The densities of one volume in a tile, on the two sheets of a slab. Each thread writes its own patches, so
 * each patch has cache lines of its own. */
typedef struct shade_patch {
  _Alignas(64) const shade_volume *volume;
  const float *before, *current; /* [256], block-major; densities on sheet k-1 and on sheet k */
  uint32_t blocks;               /* the blocks that have density on either sheet */
  const float *enter, *leave; /* [256], block-major; for each pixel, the heights at which its ray enters and
                               * leaves the volume's box; if null, the box cuts nothing visible */
  int uncut;                  /* whether the box cuts neither the slab in this tile nor the ways of light
                               * through the box to the slab */
} shade_patch;

typedef struct shade_light {
  int parallel;
  float towards[3];  /* for a parallel light: unit direction to the light; frame space */
  float position[3]; /* for a light that is not parallel: its centre; frame space */
  float color[3];    /* color * intensity */
  float of_sky;      /* if the light is a sun of the sky, which makes no highlights: the fraction of its light
                      * that lights media; for other lights 0 */
  int inverse_square;
  int shadowed;
  float path; /* length of the light's way through the slab. For a parallel light it is the sheet spacing /
               * |l.h|, where l is the light's direction and h the sheets' normal. For other lights it is the
               * sheet spacing, and each sample divides it by its own |l.h| */
  const shadow_lookup *lookups;     /* [planes of the buffer's ring]; set for a light with shadows: how
                                     * samples look up the light that reaches them */
  const sublight_lookup *sublights; /* [sublight_count]; if there are any sub-lights, a sample gets the mean
                                     * of their light */
  int sublight_count, channels;
  light_texture texture;  /* the picture that the light projects */
  light_cone cone;        /* the cone of a spot light */
  sector_fraction sector; /* the sector that this light is, if it is a part of a light within the content */
  light_caps caps;        /* the caps by which a wide light that is not parallel is described */
  int parallel_row;       /* the row in the phase tables of a wide parallel light; for other lights -1 */
  int number;             /* the light's number among the sweep's lights */
  int nearest, cubic;     /* nearest: look-ups take the nearest pixel; cubic: look-ups interpolate by cubic
                           * convolution (never for sub-lights); neither: look-ups interpolate bilinearly */
} shade_light;

typedef struct shade_job {
  sheet_rays rays; /* the rays through the picture's pixels; they give positions in frame space, in the middle
                    * between the two sheets */
  float through[3];     /* for parallel rays: the step from one sheet to the next along a ray of the eye */
  float towards_eye[3]; /* for parallel rays: unit direction to the eye */
  float eye[3];    /* the eye's position in frame space; for parallel rays, a position at which depth is 0 */
  float normal[3]; /* h */
  float path; /* length of the eye's ray through the slab. For parallel rays it is the sheet spacing / |w.h|,
               * where w is the ray's direction and h the sheets' normal. For a perspective eye it is the
               * sheet spacing, and each pixel divides it by its own |w.h| */
  int sheet;  /* k, the number of the slab's last sheet: the slab lies between sheets k-1 and k */
  int plane;  /* in the rings of the lights' buffers, the number of the plane that holds the light which
               * reaches sheet k-1 */
  float height, spacing; /* height: of sheet k above the first sheet; spacing: distance from sheet k to sheet
                          * k-1; frame units */
  int back_to_front;
  const shade_light *lights;
  int light_count;
  float ambient[3];               /* the ambient light Ia; zero in all sweeps except the first */
  float emission;                 /* 1 in the first sweep, 0 in the others, so that the volumes' emission is
                                   * added only once */
  int channels;                   /* number of channels of light attenuation: 1 or 3 */
  const scatter_field *scattered; /* the light that media scatter more than once; set in the first sweep; null
                                   * if the scene has no such light */
  const sky_light *sky;           /* the field of the sky's light; null if there is no sky, or its light is
                                   * added in another sweep */
  /* [lights of the sweep][channels]; for one tile, row by row: the fraction of light that the surfaces close
   * before the samples let pass (late/); if null, all light passes. */
  const float (*near_passing)[TILE_PIXELS];
  float near_u, near_v; /* the tile's first pixel */
} shade_job;

/* Bytes of scratch memory for a patch. It holds a block, and up to sixteen slabs into which samples are
 * packed (pack_lanes.h). */
enum { SHADE_SCRATCH_BYTES = 17 * 1984 };

/* One slab in one tile. The slab ends at the current sheet. */
typedef struct tile_slab {
  const shade_job *job;       /* the job of the slab */
  size_t tile;                /* index of the tile */
  int x, y;                   /* column and row of the tile */
  const shade_patch *patches; /* [patch_count]; the patches of the volumes that have density */
  int patch_count;
  uint32_t blocks; /* the blocks that have density and are not opaque yet, one bit each */
  int worker;      /* number of the thread */
  void *scratch;   /* [patch_count][SHADE_SCRATCH_BYTES], aligned to 64; memory of the thread */
} tile_slab;

/* Shades the tile's blocks. pixels: [16 blocks][R G B A][16]. Returns the blocks that are still open, in
 * which some pixel is not opaque yet. *samples is raised by the number of pixels composited. */
typedef uint32_t shade_tile_function(const shade_job *job, const tile_slab *tile, float *pixels,
                                     uint64_t *samples);

/* The values that are measured in each pixel for the layers depth, normal and object. Sheets go from front to
 * back. The values are: alpha; the depth at which alpha first reaches 0.01 (infinite until then); the object
 * at this depth (0 until then); which of the pixel's sixteen samples a mesh covers at this depth, one bit
 * each; and the sums of depth and normal, weighted by the alpha that each sample adds. pixels: [16
 * blocks][MEASURES][16]. */
enum {
  MEASURE_ALPHA,
  MEASURE_DEPTH_FIRST,
  MEASURE_OBJECT,
  MEASURE_SAMPLES,
  MEASURE_DEPTH,
  MEASURE_NORMAL,
  MEASURES = MEASURE_NORMAL + 3
};

/* The alpha at which depth_first and object are measured (halflight/layers.h). */
#define FIRST_OPACITY 0.01f

/* The numbers that a maximum projection keeps for each pixel and visible volume. MAXIMUM_GREATEST: the
 * greatest shown value so far, or -1 if there is none. MAXIMUM_BEFORE: the value on the sheet before the last
 * slab. MAXIMUM_SHEET: the last slab's number, or -1 if the box cuts the slab. Values are coordinates in the
 * volume's table. A tile holds [volumes][MAXIMUM_ROWS][16 blocks][16]. */
enum { MAXIMUM_GREATEST, MAXIMUM_BEFORE, MAXIMUM_SHEET, MAXIMUM_ROWS };

typedef struct maximum_values {
  float *values; /* owned; [tiles][volumes][MAXIMUM_ROWS][256]; if null, the frame is no maximum projection */
  size_t volume_count; /* number of visible volumes */
  size_t tiles;
} maximum_values;

/* Lights samples of surfaces (surface_samples.h) by the light that reaches the slab. */
typedef void shade_surface_function(const shade_job *job, struct surface_samples *samples);

/* The functions of the folder render of which each instruction set has a compiled version. */
typedef struct render_functions {
  shade_tile_function *shade, *measure, *cover, *maximum;
  shade_surface_function *surface;
} render_functions;

#endif
