/* compose/volumes.c - see volumes.h. */
#include "compose/volumes.h"

#include <math.h>
#include <string.h>

#include "compose/looks.h"
#include "compose/slice.h"
#include "core/context.h"
#include "core/memory.h"
#include "scene/drawn_scene.h"
#include "scene/function/transfer_function.h"

static bool is_sliced(const hl_composer *composer, const hl_scene_volume *volume) {
  return composer->asked[HL_ASK_SLICE].given && volume->label_count == 0;
}

/* Fits a volume's function to a maximum projection (`projected`), a slice or a film. */
static hl_status fit_function(const hl_composer *composer, const hl_scene_description *description,
                              size_t index, bool projected, hl_transfer_function *function) {
  const hl_scene_volume *volume = &description->volumes[index];
  const bool named = hl_text_for(composer, HL_ASK_TF, volume, index) != NULL,
             mapped = hl_text_for(composer, HL_ASK_COLORMAP, volume, index) != NULL,
             sliced = is_sliced(composer, volume);
  hl_status status = HL_OK;
  if (projected && !sliced && mapped && !named)
    status = hl_fade_projection(composer, volume->volume, function);
  if (status == HL_OK && sliced && !named) {
    const size_t layer = hl_slice_layer(composer, description, index);
    status = hl_make_slice_opaque(composer, volume, function);
    if (status == HL_OK && layer > 1) hl_lay_slice_over(layer - 1, function);
  }
  if (status == HL_OK && hl_is_film(composer, description, index)) hl_make_film(function);
  return status;
}

static hl_status change_volume(const hl_composer *composer, const hl_scene_description *description,
                               hl_changed_volumes *changed, size_t index) {
  const hl_asked *asked = composer->asked;
  hl_scene_volume *volume = &changed->volumes[index];
  if (asked[HL_ASK_SHADING].given) volume->shading = (hl_shading)asked[HL_ASK_SHADING].choice;
  if (asked[HL_ASK_SCATTERING].given) {
    memcpy(volume->albedo, asked[HL_ASK_SCATTERING].number, sizeof volume->albedo);
    volume->multiple_scattering = 1;
  }
  if (asked[HL_ASK_CUT_SHADING].given) volume->cut_shading = (hl_cut_shading)asked[HL_ASK_CUT_SHADING].choice;
  if (asked[HL_ASK_CUT_CASTS_SHADOW].given) volume->cut_casts_shadow = 1;
  const bool alone = description->volume_count == 1;
  hl_status status = asked[HL_ASK_CLIP].given ? hl_compose_clip(composer, volume, index, alone) : HL_OK;
  if (status == HL_OK && changed->cuts != NULL) {
    hl_cut *cuts = changed->cuts + changed->cuts_used;
    status = hl_compose_cuts(composer, volume, index, alone, cuts);
    changed->cuts_used += volume->cut_count;
  }
  const bool left_out = hl_is_left_out(composer, description, index);
  const bool sliced = is_sliced(composer, volume);
  bool looks = hl_look_replaces_functions(composer) && (sliced || !asked[HL_ASK_SLICE].given),
       iso = asked[HL_ASK_ISO].given && !left_out, functions = hl_asks_for_functions(asked) && !left_out,
       film = hl_is_film(composer, description, index);
  if (status != HL_OK || (!looks && !iso && !functions && !film)) return status;
  hl_transfer_function look = {0};
  if (looks) status = hl_compose_volume_look(composer, volume);
  if (status != HL_OK) return status;
  if (looks) look = volume->transfer_function;
  const bool projected = looks && description->volume_count == 1 && hl_is_maximum(composer, description);
  if (projected) hl_fit_projection(composer, &look);
  char color[8];
  bool colored = looks && hl_projected_color(composer, description, index, color);
  double range[2];
  status = hl_compose_function(composer, description, index, colored ? color : NULL,
                               &changed->functions[index], range);
  if (range[0] < range[1] || looks || hl_text_for(composer, HL_ASK_TF, volume, index) != NULL)
    volume->legend_low = range[0], volume->legend_high = range[1];
  if (status == HL_OK)
    status = fit_function(composer, description, index, projected, &changed->functions[index]);
  volume->transfer_function = changed->functions[index];
  hl_transfer_function_release(composer->context, &look);
  if (status != HL_OK || !iso) return status;
  hl_isosurface *own = changed->surfaces + index * hl_count_isosurfaces(&asked[HL_ASK_ISO]);
  return hl_compose_isosurfaces(composer, index, volume, own);
}

/* The number of planes by which hl_scene_for_volume() has cut bare volumes. The function must be called
 * before the options' cuts are added. */
static size_t count_holder_planes(const hl_scene_description *description) {
  size_t planes = 0;
  for (size_t v = 0; v < description->volume_count; v++) planes += description->volumes[v].cut_count;
  return planes;
}

/* Counts the small bodies that hl_scene_for_volume() has hidden in bare volumes. *share: raised to the
 * greatest fraction of a volume's bodies' voxels that is hidden. */
static size_t count_scraps(const hl_scene_description *description, double *share) {
  size_t bodies = 0;
  for (size_t v = 0; v < description->volume_count; v++) {
    const hl_scene_volume *volume = &description->volumes[v];
    hl_scraps scraps = {0};
    if (!hl_hides_scraps(volume) || hl_hide_scraps(volume, &scraps, NULL) != HL_OK) continue;
    hl_volume_release(scraps.volume);
    bodies += scraps.bodies;
    *share = fmax(*share, scraps.share);
  }
  return bodies;
}

/* Returns whether "whole" asks to show all matter of a bare volume. */
static bool shows_whole(const hl_composer *composer) {
  return composer->bare && composer->asked[HL_ASK_WHOLE].given;
}

/* Logs that the holders of a bare volume's object are cut off. */
static void tell_of_holders(const hl_composer *composer, const hl_scene_description *description) {
  size_t planes = count_holder_planes(description);
  if (composer->bare && planes > 0 && !shows_whole(composer))
    hl_log(composer->context, HL_LOG_INFO,
           "what holds the object is cut away, by %zu plane%s: --whole shows it", planes,
           planes == 1 ? "" : "s");
}

/* Logs that small bodies of a bare volume are hidden, from the functions that are shown in the end. */
static void tell_of_scraps(const hl_composer *composer, const hl_scene_description *description) {
  double share = 0;
  const size_t bodies = composer->bare ? count_scraps(description, &share) : 0;
  const bool one = bodies == 1;
  if (bodies > 0)
    hl_log(composer->context, HL_LOG_INFO,
           "%zu small bod%s beside the object, %.2g %% of all voxels of bodies, %s hidden: --whole shows %s",
           bodies, one ? "y" : "ies", 100 * share, one ? "is" : "are", one ? "it" : "them");
}

/* Refuses options for the look of volumes in a scene without volumes. */
static hl_status refuse_looks(const hl_composer *composer, const hl_scene_description *description) {
  for (int which = HL_ASK_LOOK; which <= HL_ASK_SHADING; which++)
    if (composer->asked[which].given &&
        !(which == HL_ASK_COLORMAP && hl_colors_meshes(composer, description)))
      return hl_fail(composer->error, HL_ERROR_ARGUMENT, "--%s is for volumes: the picture has none",
                     hl_option_rows[which].name);
  return HL_OK;
}

static bool changes_any(const hl_composer *composer) {
  const hl_asked *asked = composer->asked;
  return hl_look_replaces_functions(composer) || hl_asks_for_functions(asked) ||
         asked[HL_ASK_SHADING].given || asked[HL_ASK_CLIP].given || asked[HL_ASK_ISO].given ||
         hl_count_cuts(asked) > 0 || asked[HL_ASK_CUT_SHADING].given || asked[HL_ASK_SCATTERING].given ||
         asked[HL_ASK_CUT_CASTS_SHADOW].given || asked[HL_ASK_DENSITY].given;
}

static bool shows_film(const hl_composer *composer, const hl_scene_description *description) {
  bool found = false;
  for (size_t v = 0; v < description->volume_count; v++) found |= hl_is_film(composer, description, v);
  return found;
}

/* Applies "density": the option's number multiplies the extinction of matter, and with it the light that
 * matter absorbs and sends. Derived: opacity o per distance u is the extinction -ln(1 - o) / u. Labels keep
 * their own opacities. */
static void change_density(const hl_composer *composer, hl_scene_volume *volume) {
  const hl_asked *density = &composer->asked[HL_ASK_DENSITY];
  if (density->given && volume->label_count == 0)
    volume->transfer_function.unit_distance /= density->number[0];
}

/* Allocates the arrays for everything that may change. The array of cuts has room for the cuts that the scene
 * and its volumes already have, and for all of the options' cuts in the scene and in each volume. */
static hl_status make_room(const hl_composer *composer, const hl_scene_description *description,
                           hl_changed_volumes *changed) {
  hl_context *context = composer->context;
  size_t count = description->volume_count, surfaces = hl_count_isosurfaces(&composer->asked[HL_ASK_ISO]);
  size_t own = description->cut_count, added = hl_count_cuts(composer->asked);
  for (size_t v = 0; v < count; v++) own += description->volumes[v].cut_count;
  changed->count = count;
  changed->volumes = hl_allocate(context, count, sizeof *changed->volumes);
  changed->functions = hl_allocate_zeroed(context, count, sizeof *changed->functions);
  if (surfaces > 0)
    changed->surfaces = hl_allocate_zeroed(context, count * surfaces, sizeof *changed->surfaces);
  if (added > 0)
    changed->cuts = hl_allocate_zeroed(context, own + (count + 1) * added, sizeof *changed->cuts);
  bool whole = changed->volumes != NULL && changed->functions != NULL &&
               (surfaces == 0 || changed->surfaces != NULL) && (added == 0 || changed->cuts != NULL);
  if (!whole) return hl_fail_memory(composer->error, count * sizeof *changed->volumes, "the scene's volumes");
  memcpy(changed->volumes, description->volumes, count * sizeof *changed->volumes);
  return HL_OK;
}

hl_status hl_compose_volumes(const hl_composer *composer, hl_scene_description *description,
                             hl_changed_volumes *changed) {
  bool whole = shows_whole(composer), masked = composer->asked[HL_ASK_MASK].given;
  changed->seen = description->volume_count > 0 && (whole || changes_any(composer));
  tell_of_holders(composer, description);
  hl_tell_of_function(composer);
  hl_tell_of_background(composer, description);
  if (description->volume_count == 0) return refuse_looks(composer, description);
  if (!changed->seen && !masked && !shows_film(composer, description)) {
    tell_of_scraps(composer, description);
    return HL_OK;
  }
  hl_status status = make_room(composer, description, changed);
  if (status != HL_OK) return status;
  description->volumes = changed->volumes;
  for (size_t v = 0; whole && v < description->volume_count; v++) {
    changed->volumes[v].cut_count = 0;
    changed->volumes[v].scraps_least = 0;
  }
  status = hl_check_volume_names(composer, description);
  if (status == HL_OK) status = hl_check_clip_names(composer, description);
  if (status == HL_OK) status = hl_check_cut_names(composer, description);
  if (status == HL_OK && changed->cuts != NULL && description->volume_count > 1) {
    status = hl_compose_scene_cuts(composer, description, changed->cuts);
    changed->cuts_used = description->cut_count;
  }
  for (size_t i = 0; i < description->volume_count && status == HL_OK; i++)
    status = change_volume(composer, description, changed, i);
  for (size_t i = 0; i < description->volume_count && status == HL_OK; i++)
    change_density(composer, &changed->volumes[i]);
  for (size_t i = 0; i < description->volume_count && status == HL_OK && masked; i++)
    hl_compose_rest(&changed->volumes[i]);
  if (status == HL_OK) tell_of_scraps(composer, description);
  return status;
}

void hl_changed_volumes_release(hl_context *context, hl_changed_volumes *changed) {
  for (size_t i = 0; changed->functions != NULL && i < changed->count; i++)
    hl_transfer_function_release(context, &changed->functions[i]);
  hl_release(context, changed->functions);
  hl_release(context, changed->surfaces);
  hl_release(context, changed->cuts);
  hl_release(context, changed->volumes);
}
