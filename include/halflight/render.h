/* halflight/render.h - rendering a scene. */
#ifndef HALFLIGHT_RENDER_H
#define HALFLIGHT_RENDER_H

#include "image.h"
#include "layers.h"
#include "ranks.h"
#include "scene.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Makes frames of scenes, and keeps buffers and prepared volumes between frames. A renderer serves one
 * thread at a time: while it makes a frame it refuses other calls with HL_ERROR_ARGUMENT, also calls from
 * the frame's callbacks. If it is destroyed during a frame, it is released when the frame ends. Scenes may
 * be shared by any number of renderers. After fork() the child may use a renderer that was idle, or create
 * one: either starts threads of its own. */
typedef struct hl_renderer hl_renderer;

typedef struct hl_render_statistics {
  size_t struct_size;     /* set by the caller to sizeof(hl_render_statistics) */
  double seconds_prepare; /* bricks, transfer-function tables, buffers */
  double seconds_render;  /* the sheets */
  int sheets;             /* summed over sweeps */
  int sweeps;             /* one per slicing direction */
  int threads;
  hl_instruction_set instruction_set;
  uint64_t voxels_total;
  uint64_t voxels_kept;                              /* voxels that can change the picture */
  uint64_t samples_shaded;                           /* samples of the image that were classified, lit and
                                                      * composited */
  uint64_t tiles_filled_image, tiles_filled_light;   /* sheet tiles reconstructed */
  uint64_t tiles_skipped_image, tiles_skipped_light; /* sheet tiles that were skipped because they were
                                                      * already opaque or dark */
  /* wall-clock seconds per stage; the time to fill the light includes compositing the light into the shadow
   * buffer. The image is filled and shaded at the same time as the light; the elapsed time is divided in
   * proportion to the time that the threads spent on each stage. */
  double seconds_sort, seconds_fill_image, seconds_fill_light, seconds_shade, seconds_soften;
  double seconds_composite_light; /* the part of seconds_fill_light that is spent on classification and
                                     compositing */
  uint64_t pixels_filled_image, pixels_filled_light; /* sheet pixels that were reconstructed, including those
                                                      * for finding hidden blocks */
  uint64_t pixels_skipped_image, pixels_skipped_light; /* sheet pixels that were skipped in occupied places
                                                        * because they were already opaque or dark */
  char device[128]; /* the device that made the sweeps: "cpu", or a device's name (halflight/device.h) */
  char device_reason[400]; /* why the device that the context names did not make the frame; empty where the
                            * device made it, and where the context names none */
  double seconds_device;   /* seconds of the device's kernels, by its own clock; 0 for "cpu" */
  int device_launches;     /* of kernels */
  uint64_t waits; /* how often all threads waited for each other in the loops over the sheets; 0 with one
                   * thread */
} hl_render_statistics;

HL_API HL_WARN_UNUSED hl_status hl_renderer_create(hl_context *context, hl_renderer **renderer,
                                                   hl_error *error);
HL_API void hl_renderer_destroy(hl_renderer *renderer); /* null is allowed */

/* Renders a scene. pixels: the caller's buffer, [height][row_stride] floats, of which width x 4 are used in
 * each row: linear premultiplied RGBA of the volumes alone (no background), top row first. row_stride in
 * floats, at least 4 x width. statistics may be null. On an error the buffer's content is undefined. Less
 * memory is needed where the buffer is aligned to 64 bytes, its rows follow each other without gaps and width
 * and height are multiples of 16. */
HL_API HL_WARN_UNUSED hl_status hl_renderer_render(hl_renderer *renderer, const hl_scene *scene,
                                                   float *pixels, size_t row_stride,
                                                   hl_render_statistics *statistics, hl_error *error);

/* The number of rows and of columns of a cell. A picture is divided into cells, beginning in its top left
 * corner. */
#define HL_STRIP_ROWS 16

/* Divides each picture into `parts` parts. From now on the renderer makes only part number `part` (0 to parts
 * - 1) of each picture, and sets all other pixels to zero. The pixels of a part have the same bytes as in a
 * whole picture, so that several processes can make the parts of a picture and add them up. For a part, the
 * renderer computes only the shadows that the part reads; shadows of HL_SOFT_CASCADE are computed everywhere.
 * A part is a band of whole cells. The band runs along the direction, in the picture, of the brightest light
 * whose shadows are not the cascade's. Without such a light a part is every parts-th row of cells. Where a
 * part lies depends only on the scene, on `parts`, and on whether the volumes lie over ranks. Layers are
 * refused while a picture has several parts. parts 1 (default): whole pictures. */
HL_API HL_WARN_UNUSED hl_status hl_renderer_share(hl_renderer *renderer, int part, int parts,
                                                  hl_error *error);

/* Shares pictures among the processes of an MPI job, as hl_renderer_share() does: each process makes part
 * number hl_ranks_rank() of hl_ranks_size() parts. The processes exchange the light of HL_SOFT_CASCADE and of
 * the sky, so that each process computes only a part of this light, too. Bands then follow the brightest
 * light with any shadows, and a part may have two or three bands. From now on rendering is collective: every
 * rank renders the same scenes, in the same order. ranks: borrowed while the renderer renders; null: whole
 * pictures. */
HL_API HL_WARN_UNUSED hl_status hl_renderer_share_over_ranks(hl_renderer *renderer, hl_ranks *ranks,
                                                             hl_error *error);

/* Chooses the device that makes the renderer's next frames, in place of the context's device. device: as in
 * hl_context_options; copied; null: the context's device again. Pictures stay the same. */
HL_API HL_WARN_UNUSED hl_status hl_renderer_use_device(hl_renderer *renderer, const char *device,
                                                       hl_error *error);

/* Renders the picture and the requested layers. This takes longer than the picture alone: each light that has
 * layers is shaded twice more, with and without its shadow. */
HL_API HL_WARN_UNUSED hl_status hl_renderer_render_layers(hl_renderer *renderer, const hl_scene *scene,
                                                          float *pixels, size_t row_stride,
                                                          const hl_layers *layers,
                                                          hl_render_statistics *statistics, hl_error *error);

/* Puts the sky behind a picture where the scene's `background_sky` asks for it: pixels that let light through
 * show the sky's radiance, and all alphas become 1. The renderer and the reference do this by themselves for
 * whole pictures. Call this function after the parts of a picture were added up. Where the scene does not ask
 * for it, pixels stay as they are. pixels, row_stride: as for hl_renderer_render(). Errors: HL_ERROR_ARGUMENT
 * for null. */
HL_API HL_WARN_UNUSED hl_status hl_scene_show_sky(const hl_scene *scene, float *pixels, size_t row_stride,
                                                  hl_error *error);

/* Plans the frame of a scene as hl_renderer_render() does, and makes no picture. The plan explains the time
 * and the memory that a frame takes. *text: the plan as one JSON object: the picture's size and tiles, the
 * volumes with their visible bricks, the lights, the meshes, and the sweeps. Each sweep has the number,
 * spacing and direction of its sheets, and its lights with their shadow buffers. Lengths are in world units.
 * Later versions may add members. Null-terminated; free with hl_text_release(). */
HL_API HL_WARN_UNUSED hl_status hl_renderer_plan(hl_renderer *renderer, const hl_scene *scene, char **text,
                                                 hl_error *error);

/* Fills the options for writing the scene's pictures by hl_image_write() or hl_image_to_srgb8(): the
 * defaults, but with the scene's background, exposure and tone. scene may be null: the defaults alone. */
HL_API void hl_scene_write_options(const hl_scene *scene, hl_image_write_options *options);

typedef struct hl_reference_options {
  size_t struct_size; /* set by hl_reference_options_defaults() */
  int light_points;   /* points on each extended light; default 1024 */
  double step;        /* marching step in smallest voxel edges; default 0.25 */
  int threads;        /* 0: one per processor */
  int rays;  /* rays along each side of a pixel, from 1 to 8, that are averaged; default 1. 0: as many rays as
              * the renderer averages where voxels are smaller than pixels */
  int paths; /* number of paths from each pixel, from 1 to 2^24, for the estimate of light that media scatter
              * more than once; default 64 */
  float *error; /* the caller's; [height][width][3]: filled with the standard error of the estimate of
                 * scattered light; null (default): the error is not wanted */
} hl_reference_options;

HL_API void hl_reference_options_defaults(hl_reference_options *options);

/* Renders with the reference: a slow double-precision ray marcher that shares no rendering code with
 * hl_renderer. */
HL_API HL_WARN_UNUSED hl_status hl_reference_render(hl_context *context, const hl_scene *scene,
                                                    const hl_reference_options *options, float *pixels,
                                                    size_t row_stride, hl_error *error);

/* Renders the picture and the requested layers. */
HL_API HL_WARN_UNUSED hl_status hl_reference_render_layers(hl_context *context, const hl_scene *scene,
                                                           const hl_reference_options *options, float *pixels,
                                                           size_t row_stride, const hl_layers *layers,
                                                           hl_error *error);

#ifdef __cplusplus
}
#endif
#endif
