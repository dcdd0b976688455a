/* gpu/device_sweep.h - describes one sweep of a frame as plain data. Together with voxels and tables, these
 * data are all that a device needs.
 *
 * The structs have only members of 32 bits, and no pointers. The host fills them (render/device_plan.c), and
 * the kernels include this same header: its text is valid C17, OpenCL C 1.2 and CUDA C++. Unless a comment
 * says otherwise, lengths are in frame units, and positions in frame space. */
#ifndef HL_GPU_FRAME_PLAN_H
#define HL_GPU_FRAME_PLAN_H

#define PLAN_LIGHTS        16
#define PLAN_VOLUMES       16
#define PLAN_KERNEL_POWERS 6
#define PLAN_SECTORS       6
#define PLAN_CODES         256
#define PLAN_HARMONICS     9
#define PLAN_MASK_PARTS    4

/* The rays of pixels at one sheet: the members of sheet_rays (view/view.h), and the sheet's height above the
 * first sheet. */
typedef struct plan_rays {
  int perspective;
  float base[3], p0[3], pu[3], pv[3];
  float w0[3], wu[3], wv[3];
  float h0, hu, hv;
  float step;
  float height;
  /* The next members are set only for the rays, in frame space, of a light that is `soft`: */
  float position; /* the position, in its chunk, of the slab before the sheet */
  float young;    /* the weight, from 0 to 1, of the current chunk's light at the samples of this slab, which
                   * fade from the older light to it */
  int chunk;      /* number of the chunk that holds this slab, from 1 on */
} plan_rays;

/* Rays in the volume's index space: the members of box_rays (view/view.h). */
typedef struct plan_box {
  float start[3], start_u[3], start_v[3];
  float direction[3], direction_u[3], direction_v[3];
  float start_height, start_height_u, start_height_v;
  float climb, climb_u, climb_v;
  float low[3], high[3];
  float least;
  int sphere;
} plan_box;

/* A cut of the volume, as it applies to the eye's view or to a light's view. */
typedef struct plan_cut {
  int shape; /* the type of the shape: CUT_BOX and so on, with the numbers of hl_cut_type */
  int keep_inside;
  float rows[3][4];     /* maps frame space to the shape's own space (scene/geometry/cut.h) */
  float in_index[3][4]; /* maps index space to the shape's own space */
  float scale[3];       /* the number of voxels per unit of each axis of the shape's own space */
  float margin[3];      /* only in a light's view: distances like plan_light's `margin`, but along the axes of
                         * the shape's own space and in its units */
  plan_box rays;        /* rays in the shape */
} plan_cut;

#define CUT_PLANE  0
#define CUT_BOX    1
#define CUT_SPHERE 2

/* The number of columns and of sizes of caps of a table of a phase function (light/phase_table.h). */
#define PLAN_PHASE_COLUMNS 512
#define PLAN_PHASE_CAPS    64
#define PLAN_LIGHT_CAPS    4

/* A part of a wide light: the members of light_cap (light/light_caps.h). */
typedef struct plan_cap {
  float middle[3], spread[6];
} plan_cap;

/* One level of the image that a light projects: the members of texture_level (light/light_texture.h). */
typedef struct plan_texture_level {
  unsigned begin; /* the number of the level's first float among the floats of all images */
  int width, height;
  float scale[2], shift[2];
} plan_texture_level;

#define PLAN_TEXTURE_LEVELS 24

/* The image that a light projects: the members of light_texture. The width of `image` is 0 if the light
 * projects no image; its scale and shift are not used. */
typedef struct plan_texture {
  plan_texture_level image;
  float map[3][4], sharpness[2], beyond[4];
  int parallel;
  float first, edge[2];
  int level_count;
  plan_texture_level level[PLAN_TEXTURE_LEVELS];
} plan_texture;

/* A light, and the shadow buffer of a light that casts shadows. */
typedef struct plan_light {
  int parallel, shadowed, inverse_square, nearest, cubic;
  float towards[3];  /* parallel: unit direction to the light */
  float position[3]; /* not parallel: the light's centre */
  float color[3];    /* colour times intensity */
  float of_sky;      /* if the light is a sun of the sky: the fraction of its light that lights media; for
                      * other lights 0 */
  float path;        /* the members of these names in shade_light (render/slab.h) */
  float through[3];  /* the members of these names in attenuate_job (shadow/attenuate.h) */
  float cone_axis[3], cone_outer, cone_scale;
  int wide_parallel, cap_count; /* whether the light is parallel and has a row of its own in the table of the
                                 * phase function, and the number of `caps` */
  plan_cap caps[PLAN_LIGHT_CAPS];
  int sector_count, sector;
  float sector_axis[PLAN_SECTORS][3], sector_least;
  /* the shadow buffer */
  int width, height;  /* size in pixels */
  int tiles_x, tiles; /* number of its tiles */
  int first_tile;     /* index of this light's first tile among the tiles of all lights */
  int first_slab;     /* the first slab that the light reaches */
  int stride;         /* number of floats from one row of a plane to the next */
  int plane, origin;  /* number of floats of a plane, and the place of pixel (0, 0) in it */
  int soft;           /* whether the light's shadows are blurred, by chunks of slabs
                       * (shadow_cascade/cascade.h) */
  /* The beginning of the light's planes, in units of 16 floats. The planes are [ring][1 to
   * 3][channels][plane]. The first planes of a sheet are the transmittance. The next ones are the light at
   * the outside of surfaces, if the variant has it, and the light from which samples of soft lights fade. */
  unsigned planes;
  unsigned rows;   /* the beginning of the planes, one for each channel, that hold the light between the two
                    * directions of the paper's convolutions; in units of 16 floats */
  float map[3][4]; /* maps frame space to (w, w u, w v), where (u, v) is the position in the buffer */
  float slab_path; /* the member `path` of attenuate_job (shadow/attenuate.h) */
  int number;      /* of the light among the sweep's lights */
  /* Members of lights with sub-lights (gpu/kernels/sublights.h); `sublights` is 0 for other lights. */
  int sublights, first_sublight; /* the number of sub-lights, and the number of the first one among those of
                                  * all lights */
  int sublight_tiles_x, sublight_tiles_y; /* the tiles of one sub-light */
  int sublight_stride, sublight_plane;    /* the number of pixels from one row of a sub-light's plane to the
                                           * next, and of the whole plane */
  /* The beginnings of the sub-lights' planes, in units of 16 pixels, [ring][sublights][planes of a
   * sheet][sublight_plane]; of the slabs' copies, in units of 16 floats, [ring][planes of a sheet][3][plane];
   * and of the light's marks. */
  unsigned sublight_planes, halves, sublight_marks;
  int first_cut; /* among the sweep's cuts, the first cut of all volumes in the light's view */
} plan_light;

/* A volume in the view of the eye or of a light. */
typedef struct plan_bounds {
  plan_box box, content; /* box: the rays in the volume's box; content: the rays in the box around the bricks
                          * that show something */
  float margin[3]; /* only in a light's view: a distance along each axis, in voxels. If a sample is farther
                    * than this from the faces of the box, light that passes beside the faces does not reach
                    * the buffer's pixels around the sample */
} plan_bounds;

/* A sub-light: how samples look up its buffer. The members of sublight_lookup (shadow/shadow_buffer.h). */
typedef struct plan_sublight {
  float map[3][4];
  float weight[3]; /* read only if the variant has images on lights */
  int width, height;
} plan_sublight;

/* A slab's place in a sub-light's view: the members of sublight_place (shadow_sublights/sublight_field.h),
 * and members of sublight and sublight_job. */
typedef struct plan_sublight_place {
  int reaches, shifted;
  float scale[2], shift[2];
  int halves[2];
  float carry;
} plan_sublight_place;

/* The members of sublight_maps (shadow_sublights/sublights.h). */
typedef struct plan_sublight_maps {
  int reaches, comes;
  float near_scale[2], near_shift[2], far_scale[2], far_shift[2];
} plan_sublight_maps;

/* The brick of a field that covers a block of cells of level 0: the members of hl_brick_entry
 * (bricks/bricks.h). */
typedef struct plan_brick {
  int slot; /* number of the brick among the bricks that have coefficients; -1: the field is `value`
             * everywhere in the brick */
  int level;
  float value;
} plan_brick;

/* A volume's mask: the members of mask_lattice (grid/mask_lattice.h). */
typedef struct plan_mask {
  int last[3];
  float to_index[3][4], scale, offset, slope_scale, rest;
  int faces;                       /* normals are turned to the faces that the mask makes */
  int tints;                       /* the mask has colours */
  float decode[PLAN_CODES];        /* the linear values of the colours' codes */
  unsigned begin[PLAN_MASK_PARTS]; /* the beginning of each part on the device, in units of 16 bytes */
} plan_mask;

/* The parts of a mask on the device. */
#define MASK_BRICKS  0
#define MASK_FACTORS 1
#define MASK_SLOPES  2
#define MASK_COLORS  3

/* These constants equal the constants of the same names in label/mask.h. */
#define MASK_BRICK_SHIFT 2
#define MASK_EVEN        0x10000u
#define MASK_EVEN_COLOR  0x20000u

typedef struct plan_volume {
  int dimension[3], brick_count[3];
  /* The layout of the device's voxels, or of the coefficients of bricks: the bytes from row to row, and the
   * number of rows of a slice. The number of slices of a brick equals its number of rows. */
  unsigned row_bytes, slice_rows;
  int brick_shift, directory_size[3]; /* members of hl_bricks, for a field in bricks */
  float empty;                        /* stored units */
  int has_cell_bits;
  float inner[PLAN_KERNEL_POWERS], outer[PLAN_KERNEL_POWERS]; /* the kernel's polynomials */
  float to_index[3][4];
  /* the box and its faces that cut matter, in index space */
  float low[3], high[3], face_low[3], face_high[3];
  float steps[3]; /* the distances between voxels along the axes, in units of the smallest edge */
  /* the transfer function's tables (grid/classifier.h) */
  float scale, offset, first_visible, last_visible, normal_edge;
  float steepness_scale; /* of gradient opacity */
  /* the voxels' colours (voxel_colors in render/slab.h) */
  int color_last[3];
  float color_decode[PLAN_CODES];
  int bends; /* whether there is a table of bent colours */
  int several_surfaces;
  float only_beginning;
  /* members of shade_volume (render/slab.h) about surfaces at the faces of the volume's box and of cuts */
  int any_face;   /* whether the eye may see faces at which the box or a cut cuts visible matter */
  int faces_take; /* whether faces that cut visible matter are surfaces for the light, too */
  int cut_shading, cut_count;
  int light_cut_count; /* the number of the volume's cuts that count for lights: `cut_count`, or 0 */
  int face_cuts[6];    /* [axis][low, high] */
  /* the material (shade_volume in render/slab.h) */
  float ambient, diffuse, specular, shininess, emission;
  float anisotropy, phase_rows; /* phase_rows: rows_per_log2 of phase_table */
  float albedo[3];
  int absorbs, receives_shadow;
  float cast[3];   /* the extinction for lights divided by the extinction for the eye */
  float weight[3]; /* the extinction in shadow buffers divided by the extinction for the eye */
  float voxel;
  plan_mask mask; /* set if the variant has a mask */
  /* members of plane_table (grid/plane_table.h), for a function of value and gradient */
  float column_scale, column_offset, row_scale, row_offset;
  /* The next members are read only if the variant has several volumes. Whether the volume is shaded as a
   * surface, is lit, is visible, casts shadows; whether it has the variant's property of the same name: */
  int phong, lit, visible, casts, boxed, bricks, steep, masked, plane, colored;
  int first_cut; /* the number of the cuts, in a view, of the volumes before this one */
  /* The beginnings of the volume's data on the device: voxels, colours and mask in units of 16 bytes; entries
   * of the directory; bricks; floats of the tables, and of the tables of phase functions. */
  unsigned voxels_begin, directory_begin, bricks_begin, tables_begin, colors_begin, mask_begin, phases_begin;
} plan_volume;

/* The field of the sky's light: the members of sky_light (field/sky_field.h) without the cells. */
typedef struct plan_sky {
  int count[3], channels, cut;
  unsigned row_numbers;
  float low[3], inverse_cell, cell, lift;
  float stored_unit[3], color[3], open[3][PLAN_HARMONICS];
} plan_sky;

/* One sweep: all slabs of one slicing direction, from the first to the last. */
typedef struct device_sweep {
  int sheets, ring;                  /* sheets: number of sheets; ring: number of sheets whose planes a shadow
                                      * buffer keeps. The planes of sheet k are number k % ring */
  int width, height, tiles_x, tiles; /* size of the picture */
  int light_count, light_tiles, sublight_count;
  float spacing, path;
  float through[3], towards_eye[3], normal[3];
  float ambient[3], emission;
  plan_sky sky; /* set if the variant has a sky */
  plan_light lights[PLAN_LIGHTS];
} device_sweep;

/* In the device's memory, the volumes follow the sweep, plan_volume[volumes], and then the bounds of the
 * volumes in all views, plan_bounds[1 + lights][volumes]; the eye's view comes first. */

/* ---- passes over the fields of soft lights' chunks (shadow_cascade/cascade.h) ---- */

/* The sum a + (1 - thin) b of fields of one level. */
#define PASS_ADD    0
#define PASS_HALF   1 /* the sum of PASS_ADD for fields that are twice as fine as the output */
#define PASS_DOUBLE 2 /* the sum of PASS_ADD with a field b that is twice as coarse as the output */
#define PASS_BLUR   3 /* the sum of PASS_ADD with a blurred field b */
#define PASS_SPLIT  4
#define PASS_ABSORB 5
#define PASS_REFILL 6
/* Passes of the paper's convolutions (gpu/kernels/paper.h). */
#define PASS_BELOW   7
#define PASS_WANTED  8
#define PASS_ROWS    9
#define PASS_COLUMNS 10
/* Passes of sub-lights (gpu/kernels/sublights.h). */
#define PASS_HALVES    11
#define PASS_SUBLIGHTS 12
#define PASS_DARK      13
#define PASS_REACHED   14

/* Stands for a field of zeros. */
#define PASS_NOTHING 0xffffffffu

/* The number of pixels of zeros around a field (CASCADE_MARGIN), and the number that stands for 1 in a
 * field. */
#define PASS_MARGIN 48
#define PASS_WHOLE  32768

/* A pass over the tiles of a level. A field is named by the place of its pixel (0, 0). */
typedef struct plan_pass {
  int kind;
  int tiles_x, tiles_y;         /* of the output */
  int stride, stride_in;        /* numbers of pixels from row to row: in the level, and in inputs of another
                                 * level */
  unsigned a, b, thin;          /* inputs */
  unsigned to, to_thin;         /* outputs. PASS_SPLIT reads a and thin, and writes their first part to these
                                 * fields. PASS_ABSORB adds the matter at the chunk's beginning to these
                                 * fields */
  unsigned second, second_thin; /* outputs of PASS_SPLIT and PASS_ABSORB for the second part */
  unsigned boxes; /* PASS_BLUR: the number of the first box of the columns of tiles; the boxes of
                   * the rows of tiles follow. PASS_ROWS, PASS_COLUMNS: the number of the box */
  float late;     /* PASS_SPLIT: the fraction of the matter that the second output gets */
  float length;   /* PASS_ABSORB: of the chunk */
  int light;      /* of PASS_ABSORB, and of the kinds that follow it */
  int channel;    /* PASS_ABSORB, PASS_REFILL. PASS_ROWS, PASS_COLUMNS: the first of the planes of
                   * a sheet that are convolved */
  int chunk;      /* PASS_ABSORB, PASS_REFILL: number of the chunk that ends. PASS_REACHED: number of
                   * the sub-lights' run of slabs that begins */
  int sheet;      /* PASS_REFILL, and the kinds that follow it: the sheet at which the buffer
                   * changes as a whole */
  int reach;      /* PASS_BELOW, PASS_WANTED: the number of pixels beyond a tile that a convolution
                   * reads */
  unsigned marks; /* PASS_REFILL: the number of the first mark of the tiles */
  int first, run; /* of sub-lights: the first slab of the device's run of slabs, which ends with `sheet`, and
                   * the run's number */
} plan_pass;

/* As blur_box (shadow/blur.h). */
typedef struct plan_blur {
  int reach;
  float edge, scale;
} plan_blur;

/* Marks of a light's tiles. MARK_READ: the next chunk's slabs read the tile, so it is refilled. MARK_AGAIN:
 * the tile was refilled at the chunk's beginning, too. */
#define MARK_READ  1
#define MARK_AGAIN 2

/* The variant for which kernels are compiled. A member is the value of the macro that has the same name in
 * capitals. */
typedef struct plan_variant {
  int volumes; /* number of volumes. If there are several, a property of the variant means that some volume
                * has it */
  int storage; /* 0: u8, 1: u16, 2: f32 */
  int bricks;  /* whether the volume is a field in bricks, of f32 */
  int bspline; /* 1: the kernel is the cubic B-spline; else it is any polynomial of degree 5 */
  int eye_perspective;
  int phong, lit, shadowed;
  int outside;   /* whether the lights' buffers also keep the light at the outside of surfaces */
  int boxed;     /* whether the volume's box or a cut cuts visible matter */
  int cuts;      /* the volume has cuts */
  int steep;     /* the volume has gradient opacity */
  int masked;    /* the volume has a mask */
  int plane;     /* whether the transfer function depends on value and gradient */
  int colored;   /* whether the voxels have colours of their own */
  int soft;      /* some lights are soft */
  int paper;     /* some lights are convolved by the paper's method */
  int phases;    /* the volume has a table of its phase function */
  int sublights; /* some lights have sub-lights */
  int textures;  /* some lights project images */
  int emissions; /* some lights with sub-lights show images on their surfaces */
  int sky;       /* whether the sky's light is added in this sweep */
  int maximum;   /* whether the picture is a maximum projection */
  int back_to_front;
  int channels; /* number of channels of light attenuation: 1 or 3 */
} plan_variant;

/* PLAN_ENTRIES: number of entries of each table. The tables follow each other. First come sums, color and
 * shown, with four numbers for each entry; then outside, bent and steepness, with one number for each entry;
 * then, for maximum projections, the table of shown values, with four numbers for each entry. */
#define PLAN_ENTRIES      4096
#define PLAN_TABLE_ROWS   (PLAN_ENTRIES + 2)
#define PLAN_SHOWN_VALUES (PLAN_TABLE_ROWS * 15)
#define PLAN_TABLE_FLOATS (PLAN_TABLE_ROWS * 19)

/* The numbers of a row of the table of shown values; these constants equal SHOWN_FROM and so on in
 * plan/shown_values.h. */
#define PLAN_SHOWN_FROM  0
#define PLAN_SHOWN_TO    1
#define PLAN_SHOWN_BELOW 2

/* The two tables of a function of value and gradient, sums and color (plane_table in grid/plane_table.h),
 * follow the tables above. Each has PLAN_PLANE_FLOATS numbers: four for each point of the plane. */
#define PLAN_PLANE_COLUMNS 512
#define PLAN_PLANE_ROWS    256
#define PLAN_PLANE_STRIDE  (PLAN_PLANE_COLUMNS + 1)
#define PLAN_PLANE_FLOATS  ((PLAN_PLANE_ROWS + 1) * PLAN_PLANE_STRIDE * 4)

#endif
