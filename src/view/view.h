/* view/view.h - describes the rays by which the pixels of the eye's picture, or of a light's buffer, see the
 * sheets.
 *
 * A view is a bundle of rays, one for each pixel. The rays come from one point (perspective camera, point
 * light) or are parallel (orthographic camera, directional light). The picture plane may have any tilt: a
 * shadow buffer is perpendicular to the light for hard shadows and parallel to the sheets for soft shadows
 * (fig. 17 of the paper). Pixel (i, j) has its centre at (i + 1/2, j + 1/2). Positions are in frame space:
 * the world moved so that the scene's centre is the origin. Float arithmetic is then exact enough even for
 * scenes far from the world's origin. */
#ifndef HL_VIEW_VIEW_H
#define HL_VIEW_VIEW_H

#include <stddef.h>
#include <stdint.h>

#include "core/vector.h"

/* Pictures are made of tiles of 16x16 pixels. A tile consists of sixteen blocks of 4x4 pixels; a block fills
 * sixteen lanes. */
enum { TILE = 16, BLOCK = 4, TILE_BLOCKS = 16, BLOCK_PIXELS = 16, TILE_PIXELS = 256, ALL_BLOCKS = 0xffff };

/* Functions that convert a pixel's column and row in its tile to the pixel's number, and back. Pixels are
 * numbered block by block. */
static inline int hl_pixel_number(int column, int row) {
  return (row / BLOCK * 4 + column / BLOCK) * BLOCK_PIXELS + row % BLOCK * BLOCK + column % BLOCK;
}
static inline int hl_pixel_column(int number) {
  return number / BLOCK_PIXELS % 4 * BLOCK + number % BLOCK_PIXELS % BLOCK;
}
static inline int hl_pixel_row(int number) {
  return number / BLOCK_PIXELS / 4 * BLOCK + number % BLOCK_PIXELS / BLOCK;
}

/* The number of tiles that cover `pixels` pixels. */
static inline int hl_tiles(int pixels) { return (pixels + TILE - 1) / TILE; }

/* The index of a pixel's first value in an array [tiles][TILE_BLOCKS][values][BLOCK_PIXELS]. tiles_x: tiles
 * in a row of the array. The pixel's next values follow at distances of BLOCK_PIXELS. */
static inline size_t hl_place_in_tiles(size_t tiles_x, int values, int column, int row) {
  size_t tile = (size_t)(row / TILE) * tiles_x + (size_t)(column / TILE);
  size_t number = (size_t)hl_pixel_number(column % TILE, row % TILE);
  return (tile * TILE_BLOCKS + number / BLOCK_PIXELS) * (size_t)values * BLOCK_PIXELS + number % BLOCK_PIXELS;
}

/* The number of pixels in a set of blocks. Bits are counted by adding them in pairs, in fours and so on,
 * because baseline processors have no instruction that counts bits. */
static inline uint64_t hl_pixels_of_blocks(uint32_t blocks) {
  blocks -= blocks >> 1 & 0x5555;
  blocks = (blocks & 0x3333) + (blocks >> 2 & 0x3333);
  blocks = (blocks + (blocks >> 4)) & 0x0f0f;
  return (uint64_t)((blocks + (blocks >> 8)) & 31) * BLOCK_PIXELS;
}

typedef struct view {
  bool perspective;
  int width, height; /* size of the view in pixels */
  vec3 origin;       /* for a perspective view: the eye, from which the rays come; frame space */
  /* for a perspective view: corner + u du + v dv is the direction of the ray of the continuous pixel (u, v);
   * for a parallel view it is the start of this ray */
  vec3 corner, du, dv;
  vec3 direction; /* for a parallel view: the unit direction of all rays */
  /* the map from a point X to pixels: (w, w u, w v) = inverse * (X - origin) for a perspective view,
   * (distance, u, v) = inverse * (X - corner) for a parallel view */
  mat3 inverse;
} view;

/* The number of tiles that cover a view. */
static inline size_t hl_view_tiles(const view *view) {
  return (size_t)hl_tiles(view->width) * (size_t)hl_tiles(view->height);
}

/* Sets the member `inverse` of a view from the other members. Returns false if the view is degenerate. */
bool hl_view_finish(view *view);

/* Finds the continuous pixel at which a view sees a point. Returns false if the point lies behind a
 * perspective view's eye. */
bool hl_view_project(const view *view, vec3 point, double uv[2]);

/* Finds the ray of a view through the continuous pixel (u, v): its start and its direction, which is not
 * normalised. */
void hl_view_ray(const view *view, double u, double v, vec3 *start, vec3 *direction);

/* Finds (w, w u, w v) as affine functions of a point of another space. to_frame: maps this space to frame
 * space. rows: for each function, the factors of the point's coordinates, and the constant. In a parallel
 * view w is 1. */
void hl_view_homogeneous(const view *view, affine3 to_frame, double rows[3][4]);

/* The points where the rays of pixels meet one sheet. The points are in a space that the caller of
 * hl_view_sheet_rays() chooses. (u, v) are pixels, counted from the first pixel's centre. Let P = p0 + u pu +
 * v pv, W = w0 + u wu + v wv and H = h.W = h0 + u hu + v hv. In a perspective view the position is base + P /
 * H and the direction is W; in a parallel view the position is P. Derived: the ray E + s W meets the sheet
 * h.X = z at s = (z - h.E) / H. With base = E + t Wc, for any t and Wc, P is (z - h.E) W - t H Wc. It is
 * linear in u and v, because W and H are. Wc is chosen as the middle ray's direction, and base as this ray's
 * point on the sheet. So P is never larger than the visible area, however far away the eye is. */
typedef struct sheet_rays {
  int perspective;
  float base[3], p0[3], pu[3], pv[3];
  float w0[3], wu[3], wv[3]; /* the direction W; set for perspective views only */
  float h0, hu, hv;
  float step; /* the height of the sheet above the eye: z - h.E */
} sheet_rays;

/* Finds the rays of a view at a sheet. normal: unit normal of the sheets; height: the sheet's height h.X.
 * from_frame: maps frame space to the space of the result. */
void hl_view_sheet_rays(const view *view, vec3 normal, double height, affine3 from_frame, sheet_rays *rays);

/* The sheets of a sweep: sheet k lies at height first + k * spacing along the unit normal. */
typedef struct sheet_stack {
  vec3 normal; /* the unit normal h of the sheets; frame space */
  double first, spacing;
  int count;
} sheet_stack;

static inline double hl_sheet_height(const sheet_stack *sheets, int sheet) {
  return sheets->first + sheet * sheets->spacing;
}

/* ---- where rays enter and leave a box ----
 *
 * Counting sheets would round a homogeneous box's depth to whole sheets. So each ray keeps the heights at
 * which it enters and leaves the box, and the slab between two sheets counts only as far as it lies between
 * these heights (derived; exact for a homogeneous medium). */

/* The rays of a view in one grid's index space. A ray is start + s * direction with s > least; start and
 * direction are linear functions of the pixel. The ray's height above the first sheet is start_height + s *
 * climb. */
typedef struct box_rays {
  float start[3], start_u[3], start_v[3];
  float direction[3], direction_u[3], direction_v[3];
  float start_height, start_height_u, start_height_v;
  float climb, climb_u, climb_v;
  float low[3], high[3]; /* the box, in index space */
  float least;           /* the least s that counts; in a perspective view it is the s of the eye */
  int sphere;            /* if set, a sphere of radius 1 around the origin is used in place of the box */
} box_rays;

/* The type of the function that finds where the rays of one tile enter and leave a box. enter, leave: [256],
 * block after block; heights above the first sheet. A ray that misses the box has enter > leave. */
typedef void coverage_tile_function(const box_rays *rays, int tile_x, int tile_y, float *enter, float *leave);

/* Sets up the rays of a view for one box. low, high: the box, in index space. */
void hl_box_rays(const view *view, vec3 normal, double first_height, affine3 frame_to_index,
                 const double low[3], const double high[3], box_rays *rays);

/* ---- bounds of boxes in a view ---- */

/* Bounds of a box of index space: in a view's picture, and along the sheets' normal. */
typedef struct footprint_bounds {
  double low[2], high[2];         /* bounds in the picture, in continuous pixels */
  double low_height, high_height; /* bounds of the heights along the normal of the sheets */
} footprint_bounds;

/* Maps from a grid's index space to a view's picture, and to heights along the sheets' normal. */
typedef struct footprint_map {
  double view[3][4]; /* the rows of the map to (w, w u, w v) */
  double height[4];
} footprint_map;

void hl_footprint_map(const view *view, vec3 normal, affine3 index_to_frame, footprint_map *map);
/* Finds the bounds of a box in a view; the box is given by its centre and half of its edges. Returns false if
 * the whole box lies behind the view. */
bool hl_footprint_bounds(const footprint_map *map, const double centre[3], const double half[3],
                         footprint_bounds *bounds);

#endif
