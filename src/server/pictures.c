/* server/pictures.c - encodes rendered images as the files that a page requests, with their overlays. */
#define _GNU_SOURCE
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <halflight/figure.h>

#include "parts.h"

static hl_status write_jpeg(const hl_image *image, const hl_image_write_options *options, int quality,
                            server_answer *answer, hl_error *error) {
  int width = hl_image_width(image), height = hl_image_height(image);
  hl_image_write_options opaque = *options;
  opaque.background_transparent = 0;
  uint8_t *rgba = malloc(4 * (size_t)width * (size_t)height);
  hl_status status = rgba != NULL ? hl_image_to_srgb8(image, &opaque, rgba, 4 * (size_t)width, error)
                                  : HL_ERROR_MEMORY;
  if (status == HL_OK) {
    answer->from_malloc = encode_jpeg(rgba, width, height, quality, &answer->length);
    answer->type = "image/jpeg";
    if (answer->from_malloc == NULL) status = HL_ERROR_MEMORY;
  }
  free(rgba);
  if (status == HL_ERROR_MEMORY) snprintf(error->message, sizeof error->message, "no memory for a JPEG");
  return status;
}

static bool has_overlay(const frame_request *request) {
  return request->scale_bar || request->legend || request->marks || request->axes != HL_AXES_NONE;
}

/* Describes a figure that the picture fills, with the overlays that the request asks for. In a perspective
 * picture the scale bar is right at the depth of the camera's target. */
static void make_figure(const hl_image *image, const hl_scene *scene, const frame_request *request,
                        hl_figure *figure, hl_figure_panel *panel) {
  hl_figure_defaults(figure);
  *panel = (hl_figure_panel){0};
  hl_overlay_defaults(&panel->overlay);
  hl_figure_of_picture(image, scene, 0, figure, panel);
  panel->overlay.scale_bar = request->scale_bar;
  panel->overlay.scale_bar_depth = HL_DEPTH_OF_TARGET;
  panel->overlay.legend = request->legend;
  panel->overlay.marks = request->marks;
  panel->overlay.axes = (hl_axes)request->axes;
  panel->overlay.world_unit = request->unit;
}

hl_status check_overlay(const server *s, const hl_scene *scene, const frame_request *request,
                        hl_error *error) {
  const hl_scene_description *d = hl_scene_describe(scene);
  hl_context *context = s->options.context;
  hl_image *trial = NULL;
  if (!has_overlay(request)) return HL_OK;
  hl_status status = hl_image_create(context, d->width, d->height, &trial, error);
  if (status == HL_OK) {
    hl_figure figure;
    hl_figure_panel panel;
    make_figure(trial, scene, request, &figure, &panel);
    status = hl_figure_check(context, &figure, error);
  }
  hl_image_destroy(trial);
  return status;
}

hl_status render_small(const server *s, hl_renderer *renderer, const hl_scene *scene, hl_image **image,
                       hl_render_statistics *statistics, hl_error *error) {
  enum { MOST_PIXELS_ALONG = 256 };
  hl_scene_description d = *hl_scene_describe(scene);
  const double part = fmin(1, (double)MOST_PIXELS_ALONG / fmax(d.width, d.height));
  d.width = (int)fmax(1, round(part * d.width));
  d.height = (int)fmax(1, round(part * d.height));
  d.render.pixel_samples = 0;
  hl_scene *small = NULL;
  hl_status status = hl_scene_create(s->options.context, &d, &small, error);
  if (status == HL_OK) status = hl_image_create(s->options.context, d.width, d.height, image, error);
  if (status == HL_OK)
    status = hl_renderer_render(renderer, small, hl_image_pixels(*image), 4 * (size_t)d.width, statistics,
                                error);
  hl_scene_release(small);
  return status;
}

hl_status write_overlay(const server *s, const hl_image *matter, const hl_scene *scene,
                        const frame_request *request, server_answer *answer, hl_error *error) {
  const hl_scene_description *d = hl_scene_describe(scene);
  hl_context *context = s->options.context;
  hl_image *place = NULL;
  hl_status status = hl_image_create(context, d->width, d->height, &place, error);
  if (status == HL_OK) {
    hl_figure figure;
    hl_figure_panel panel;
    make_figure(place, scene, request, &figure, &panel);
    panel.image = NULL;
    panel.matter = matter;
    figure.background_transparent = 1;
    status = hl_figure_encode(context, &figure, "png", NULL, &answer->bytes, &answer->length, error);
    answer->type = "image/png";
  }
  hl_image_destroy(place);
  return status;
}

/* Writes a picture with the bytes that `halflight render` writes for the scene. */
static hl_status write_exact(const server *s, const hl_scene *scene, const hl_image *image,
                             hl_image_write_options *options, const frame_request *request,
                             server_answer *answer, hl_error *error) {
  hl_context *context = s->options.context;
  char *json = NULL;
  hl_status status = request->metadata ? hl_scene_to_json(context, scene, &json, error) : HL_OK;
  options->scene_json = json;
  options->png_depth = request->depth;
  if (status == HL_OK && has_overlay(request)) {
    hl_figure figure;
    hl_figure_panel panel;
    make_figure(image, scene, request, &figure, &panel);
    figure.background_transparent = options->background_transparent;
    status = hl_figure_encode(context, &figure, request->format, options, &answer->bytes, &answer->length,
                              error);
  } else if (status == HL_OK) {
    status = hl_image_encode(context, image, request->format, options, &answer->bytes, &answer->length,
                             error);
  }
  answer->type = strcmp(request->format, "png") == 0   ? "image/png"
                 : strcmp(request->format, "exr") == 0 ? "image/x-exr"
                                                       : "application/octet-stream";
  hl_text_release(context, json);
  return status;
}

hl_status write_picture(const server *s, const hl_scene *scene, const hl_image *image,
                        const frame_request *request, server_answer *answer, hl_error *error) {
  hl_image_write_options options;
  hl_scene_write_options(scene, &options);
  return strcmp(request->format, "jpeg") == 0
             ? write_jpeg(image, &options, request->quality, answer, error)
             : write_exact(s, scene, image, &options, request, answer, error);
}
