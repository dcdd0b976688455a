/* gpu/device_sweep.h - one sweep of a frame as plain data: all that a device needs besides voxels and tables.
 *
 * The structs have members of 32 bits alone and no pointers. The host fills them (render/device_plan.c), and
 * the kernels read the same text: it is C17, OpenCL C 1.2 and CUDA C++. Lengths are in frame units, positions
 * in frame space, where no comment says otherwise. */
#ifndef HL_GPU_FRAME_PLAN_H
#define HL_GPU_FRAME_PLAN_H

#define PLAN_LIGHTS        16
#define PLAN_KERNEL_POWERS 6
#define PLAN_SECTORS       6

/* Where pixels see one sheet: the members of sheet_rays (view/view.h), and the sheet's height above the
 * first. */
typedef struct plan_rays {
  int perspective;
  float base[3], p0[3], pu[3], pv[3];
  float w0[3], wu[3], wv[3];
  float h0, hu, hv;
  float step;
  float height;
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

/* A light, with the shadow buffer of one that casts shadows. */
typedef struct plan_light {
  int parallel, shadowed, inverse_square, nearest, cubic;
  float towards[3];  /* parallel: unit direction to the light */
  float position[3]; /* else: the light's centre */
  float color[3];    /* colour times intensity */
  float of_sky;      /* what a medium takes of a sun of the sky; else 0 */
  float path;        /* as in shade_light (render/slab.h) */
  float cone_axis[3], cone_outer, cone_scale;
  int sector_count, sector;
  float sector_axis[PLAN_SECTORS][3], sector_least;
  /* the shadow buffer */
  int width, height;  /* pixels */
  int tiles_x, tiles; /* its tiles */
  int first_tile;     /* of its tiles among those of all lights */
  int first_slab;     /* the first slab that light reaches */
  int stride;         /* floats from row to row of a plane */
  int plane, origin;  /* floats of a plane, and the offset of pixel (0, 0) in it */
  unsigned planes; /* where the light's planes begin, in units of 16 floats: [ring][1 or 2][channels][plane],
                      of the transmittance and of the light at the outside of surfaces */
  float map[3][4]; /* frame space to (w, w u, w v) of the buffer */
  float slab_path; /* as path in attenuate_job (shadow/attenuate.h) */
  plan_box box, content;
  float margin[3]; /* voxels: farther from the box's faces, no light passes beside them to the pixels around a
                      sample */
} plan_light;

typedef struct plan_volume {
  int dimension[3], brick_count[3];
  unsigned row_bytes, slice_rows; /* of the device's voxels: from row to row; rows from slice to slice */
  float empty;                    /* stored units */
  int has_cell_bits;
  float inner[PLAN_KERNEL_POWERS], outer[PLAN_KERNEL_POWERS]; /* the kernel's polynomials */
  float to_index[3][4];
  float low[3], high[3], face_low[3], face_high[3]; /* index space: the box, and its faces that cut matter */
  float steps[3]; /* the distances between voxels along the axes, in units of the smallest edge */
  /* the transfer function's tables (grid/classifier.h) */
  float scale, offset, first_visible, last_visible, normal_edge;
  int bends; /* the table of bent colours is there */
  int several_surfaces;
  float only_outside, side;
  /* surfaces at the box's faces (shade_volume in render/slab.h) */
  int any_face, cut_shading;
  int face_cuts[6]; /* [axis][low, high] */
  /* the material (shade_volume in render/slab.h) */
  float ambient, diffuse, specular, shininess, emission;
  float anisotropy;
  float albedo[3];
  int absorbs, receives_shadow;
  float cast[3];   /* relative extinction towards the lights */
  float weight[3]; /* relative extinction in shadow buffers */
  float voxel;
} plan_volume;

/* One sweep: all slabs of one slicing direction. */
typedef struct device_sweep {
  int sheets, ring;                  /* planes that shadow buffers keep: sheet k's at k % ring */
  int width, height, tiles_x, tiles; /* of the picture */
  int light_count, light_tiles;
  float spacing, path;
  float through[3], towards_eye[3], normal[3];
  float ambient[3], emission;
  plan_volume volume;
  plan_box box, content; /* the eye's rays, and the volume's box and that of its bricks that show something */
  plan_light lights[PLAN_LIGHTS];
} device_sweep;

/* What kernels are compiled for: the values of the macros of the same names in capitals. */
typedef struct plan_variant {
  int storage; /* 0: u8, 1: u16, 2: f32 */
  int bspline; /* the kernel is the cubic B-spline; else any polynomial of degree 5 */
  int eye_perspective;
  int phong, lit, shadowed;
  int outside; /* the lights' buffers keep the light at the outside of surfaces, too */
  int boxed;   /* the volume's box cuts something visible */
  int back_to_front;
  int channels; /* of light attenuation: 1 or 3 */
} plan_variant;

/* Entries of each of the tables, which follow each other: sums, color and shown with four numbers an entry,
 * outside and bent with one. */
#define PLAN_ENTRIES      4096
#define PLAN_TABLE_ROWS   (PLAN_ENTRIES + 2)
#define PLAN_TABLE_FLOATS (PLAN_TABLE_ROWS * 14)

#endif
