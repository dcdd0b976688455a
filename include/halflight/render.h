/* halflight/render.h - renders pictures and layers of scenes, and tells the statistics of a frame. */
#ifndef HALFLIGHT_RENDER_H
#define HALFLIGHT_RENDER_H

#include "image.h"
#include "layers.h"
#include "ranks.h"
#include "scene.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A renderer makes frames of scenes, and keeps buffers and prepared volumes between frames. A renderer serves
 * one thread at a time: while it makes a frame it refuses other calls with HL_ERROR_ARGUMENT, also calls from
 * the frame's callbacks. If it is destroyed during a frame, it is released when the frame ends. Scenes may be
 * shared by any number of renderers. After fork(), the child may use a renderer that was idle at the fork, or
 * create one. Such a renderer starts threads of its own in the child. */
typedef struct hl_renderer hl_renderer;

/* Statistics of one frame: times in seconds, and the numbers of things that the renderer has done. */
typedef struct hl_render_statistics {
  size_t struct_size;     /* set by the caller to sizeof(hl_render_statistics) */
  double seconds_prepare; /* time for making bricks, tables of transfer functions and buffers */
  double seconds_render;  /* time for the sweeps over all sheets */
  int sheets;             /* number of sheets, summed over all sweeps */
  int sweeps;             /* number of sweeps; each slicing direction has one */
  int threads;
  hl_instruction_set instruction_set;
  uint64_t voxels_total;
  uint64_t voxels_kept;                              /* number of voxels that can change the picture */
  uint64_t samples_shaded;                           /* number of the picture's samples that were classified,
                                                      * lit and composited */
  uint64_t tiles_filled_image, tiles_filled_light;   /* number of tiles of sheets that were reconstructed */
  uint64_t tiles_skipped_image, tiles_skipped_light; /* number of tiles of sheets that were skipped because
                                                      * they were already opaque or dark */
  /* Wall-clock seconds of each stage. The image is filled and shaded at the same time as the light; the
   * elapsed time is divided in proportion to the time that the threads spent on each stage.
   * seconds_fill_light includes compositing the light into the shadow buffer. */
  double seconds_sort, seconds_fill_image, seconds_fill_light, seconds_shade, seconds_soften;
  double seconds_composite_light; /* the part of seconds_fill_light for classifying samples and compositing
                                   * light */
  uint64_t pixels_filled_image, pixels_filled_light;   /* number of pixels of sheets that were reconstructed,
                                                        * including the pixels that were reconstructed to find
                                                        * hidden blocks */
  uint64_t pixels_skipped_image, pixels_skipped_light; /* number of pixels of sheets that lie where volumes
                                                        * show something but were skipped, because they were
                                                        * already opaque or dark */
  char device[128];        /* the device that made the frame's sweeps: "cpu", or a device's name
                            * (halflight/device.h) */
  char device_reason[400]; /* why the device that the context names did not make the frame; empty if the
                            * device made it, and if the context names none */
  double seconds_device;   /* seconds that the device's kernels ran, by the device's clock; 0 for "cpu" */
  int device_launches;     /* number of kernels that were launched on the device */
  uint64_t waits; /* number of times that all threads waited for each other in the loops over the sheets; 0
                   * with one thread */
} hl_render_statistics;

HL_API HL_WARN_UNUSED hl_status hl_renderer_create(hl_context *context, hl_renderer **renderer,
                                                   hl_error *error);
HL_API void hl_renderer_destroy(hl_renderer *renderer); /* null is allowed */

/* Renders a scene. pixels: the caller's buffer, [height][row_stride] floats, of which width x 4 are used in
 * each row: linear premultiplied RGBA of the volumes alone (no background), top row first. row_stride: number
 * of floats, at least 4 x width. statistics may be null. On an error the buffer's content is undefined. The
 * renderer needs less memory if the buffer is aligned to 64 bytes, its rows follow each other without gaps,
 * and width and height are multiples of 16. */
HL_API HL_WARN_UNUSED hl_status hl_renderer_render(hl_renderer *renderer, const hl_scene *scene,
                                                   float *pixels, size_t row_stride,
                                                   hl_render_statistics *statistics, hl_error *error);

/* The number of rows, and of columns, of a cell of a picture. hl_renderer_share() divides a picture into
 * square cells, beginning in its top left corner. */
#define HL_STRIP_ROWS 16

/* Divides each picture into `parts` parts. From now on the renderer makes only part number `part` (from 0 to
 * parts - 1) of each picture, and sets all other pixels to zero. The pixels of a part have the same bytes as
 * in a whole picture, so that several processes can make the parts of a picture and add them up. For a part,
 * the renderer computes only the shadows that the part needs; shadows of HL_SOFT_CASCADE are computed for the
 * whole picture. A part is a band of whole cells. The band runs along the direction, in the picture, of the
 * brightest light whose shadows are not of HL_SOFT_CASCADE. Without such a light, a part is every parts-th
 * row of cells. The place of a part depends only on the scene, on `parts`, and on whether the volumes lie
 * over ranks. Layers are refused while a picture has several parts. parts 1 (default): the renderer makes
 * whole pictures. */
HL_API HL_WARN_UNUSED hl_status hl_renderer_share(hl_renderer *renderer, int part, int parts,
                                                  hl_error *error);

/* Shares pictures among the processes of an MPI job, as hl_renderer_share() does: each process makes part
 * number hl_ranks_rank() of hl_ranks_size() parts. The processes exchange the light of HL_SOFT_CASCADE and of
 * the sky, so that each process computes only a part of this light, too. The bands run along the direction of
 * the brightest light with shadows of any kind, and a part may have two or three bands. From now on rendering
 * is collective: every rank renders the same scenes, in the same order. ranks: borrowed while the renderer
 * renders; null stands for whole pictures. */
HL_API HL_WARN_UNUSED hl_status hl_renderer_share_over_ranks(hl_renderer *renderer, hl_ranks *ranks,
                                                             hl_error *error);

/* Chooses the device that makes the renderer's next frames, in place of the device that the context names.
 * device: a text as in hl_context_options.device; copied; null stands for the device that the context names.
 * The pictures' bytes do not depend on the device. */
HL_API HL_WARN_UNUSED hl_status hl_renderer_use_device(hl_renderer *renderer, const char *device,
                                                       hl_error *error);

/* Renders the picture, and the layers whose buffers are not null (halflight/layers.h). This takes longer than
 * the picture alone, because each light with a layer is shaded twice more, with and without its shadow. The
 * other arguments are the same as for hl_renderer_render(). */
HL_API HL_WARN_UNUSED hl_status hl_renderer_render_layers(hl_renderer *renderer, const hl_scene *scene,
                                                          float *pixels, size_t row_stride,
                                                          const hl_layers *layers,
                                                          hl_render_statistics *statistics, hl_error *error);

/* Puts the sky behind a picture if the scene's `background_sky` asks for it. Pixels with an alpha below 1
 * then show the sky's radiance, and all alphas become 1. If the scene does not ask for it, the pixels stay as
 * they are. The renderer and the reference do this by themselves for whole pictures. Call this function for a
 * picture whose parts you have added up. pixels, row_stride: as for hl_renderer_render(). Errors:
 * HL_ERROR_ARGUMENT for null. */
HL_API HL_WARN_UNUSED hl_status hl_scene_show_sky(const hl_scene *scene, float *pixels, size_t row_stride,
                                                  hl_error *error);

/* Plans the frame of a scene as hl_renderer_render() does, but makes no picture. The plan explains the time
 * and the memory that a frame takes. *text: the plan as one JSON object: the picture's size and tiles, the
 * volumes with their visible bricks, the lights, the meshes, and the sweeps. Each sweep has the number,
 * spacing and direction of its sheets, and its lights with their shadow buffers. Lengths are in world units.
 * Later versions may add members. Null-terminated; free with hl_text_release(). */
HL_API HL_WARN_UNUSED hl_status hl_renderer_plan(hl_renderer *renderer, const hl_scene *scene, char **text,
                                                 hl_error *error);

/* Fills the options with which hl_image_write() or hl_image_to_srgb8() shows the scene's pictures. They are
 * the defaults, but with the background, exposure and tone of the scene. If scene is null, they are the
 * defaults alone. */
HL_API void hl_scene_write_options(const hl_scene *scene, hl_image_write_options *options);

typedef struct hl_reference_options {
  size_t struct_size; /* set by hl_reference_options_defaults() */
  int light_points;   /* number of points on each extended light, and number of cells of the sky; default
                       * 1024 */
  double step;        /* the longest marching step, in units of the shortest voxel edge; default 0.25 */
  int threads;        /* 0 stands for one thread per processor */
  int rays;  /* number of rays along each side of a pixel, from 1 to 8, that are averaged; default 1. 0 stands
              * for the renderer's number of rays, which is greater than 1 where voxels are smaller than
              * pixels */
  int paths; /* number of paths from each pixel, from 1 to 2^24, for the estimate of light that media scatter
              * more than once; default 64 */
  float *error; /* the caller's; [height][width][3]: receives the standard error of the estimated light that
                 * media scatter more than once; null (default): the error is not wanted */
} hl_reference_options;

HL_API void hl_reference_options_defaults(hl_reference_options *options);

/* Renders a picture with the reference: a slow double-precision ray marcher that shares no rendering code
 * with hl_renderer. */
HL_API HL_WARN_UNUSED hl_status hl_reference_render(hl_context *context, const hl_scene *scene,
                                                    const hl_reference_options *options, float *pixels,
                                                    size_t row_stride, hl_error *error);

/* Renders a picture with the reference, and the layers whose buffers are not null (halflight/layers.h). */
HL_API HL_WARN_UNUSED hl_status hl_reference_render_layers(hl_context *context, const hl_scene *scene,
                                                           const hl_reference_options *options, float *pixels,
                                                           size_t row_stride, const hl_layers *layers,
                                                           hl_error *error);

#ifdef __cplusplus
}
#endif
#endif
