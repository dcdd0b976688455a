/* halflight/halflight.h - the whole library in one header: pictures of volumes that cast shadows.
 *
 * A picture of a volume's file takes seven calls: hl_context_create(), hl_volume_load(),
 * hl_scene_for_volume(), hl_renderer_create(), hl_image_create(), hl_renderer_render() and hl_image_write().
 * The example program picture.c makes these calls. It is installed in share/doc/halflight/examples, beside
 * programs that start from arrays in memory, show pictures in windows, move a camera or ask for layers. */
#ifndef HALFLIGHT_HALFLIGHT_H
#define HALFLIGHT_HALFLIGHT_H

#include "compose.h"
#include "context.h"
#include "device.h"
#include "figure.h"
#include "formats.h"
#include "grids.h"
#include "image.h"
#include "layers.h"
#include "light.h"
#include "mesh.h"
#include "page.h"
#include "particles.h"
#include "preview.h"
#include "ranks.h"
#include "render.h"
#include "reslice.h"
#include "resolutions.h"
#include "scene.h"
#include "settings.h"
#include "shape.h"
#include "transfer_function.h"
#include "volume.h"

#endif
