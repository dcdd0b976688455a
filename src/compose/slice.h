/* compose/slice.h - applies the option "slice" AXIS=AT: a plane through the volumes, seen at a right angle
 * and without light, on which each value has its own grey or colour. The name of a body's plane (axial,
 * coronal, sagittal) may stand for the axis across the plane; without AT the plane lies in the middle of the
 * volumes. */
#ifndef HL_COMPOSE_SLICE_H
#define HL_COMPOSE_SLICE_H

#include "compose/composer.h"

enum { HL_SLICE_TEXT = 80 };

/* The number of volumes that are no label maps. */
size_t hl_count_values(const hl_scene_description *description);

/* Refuses a value of "slice" that is no plane, and options that exclude "slice". */
hl_status hl_check_slice(const hl_asked *asked, hl_error *error);

/* Adds the options that "slice" stands for: the plane as "cut-plane", "ortho", "whole" and "shading" flat.
 * The kernel becomes linear if no labels are shown, so that the picture shows the voxels' own values. Options
 * that the caller gave are not changed. Names of a body's planes are refused if no file states the body's
 * directions. plane: [HL_SLICE_TEXT]; memory for the text of the plane, to which `asked` then points. */
hl_status hl_expand_slice(const hl_scene_description *description, hl_asked *asked, char *plane,
                          hl_error *error);

/* Finds the view of "slice". Bodies are seen as radiologists see them: from the feet, the front or the left.
 * Other volumes are seen with x to the right, and y down or z up. Returns false if "slice" is not given. */
bool hl_slice_view(const hl_composer *composer, const hl_scene_description *description, hl_view *view);

/* Writes the range of values that a slice shows if no option gives one: the window that the volume's file
 * asks for, or a window of soft tissue for Hounsfield units. Returns false if the file asks for no window and
 * values are not Hounsfield units. */
bool hl_slice_range(const hl_volume *volume, char text[HL_SLICE_TEXT]);

/* Makes all values of a volume nearly opaque within half a voxel's edge. The function's points are owned by
 * the caller. */
hl_status hl_make_slice_opaque(const hl_composer *composer, const hl_scene_volume *volume,
                               hl_transfer_function *function);

/* The number, from 1, of volume `index` among volumes of values that lie over each other on a slice. Volumes
 * lie over each other if a volume of values other than the first has a colormap. Otherwise the colours of the
 * volumes add up, as the colours of channels do, and the number is 0. */
size_t hl_slice_layer(const hl_composer *composer, const hl_scene_description *description, size_t index);

/* Lays an opaque volume over `below` other volumes. The volume hides the others where its value is at least
 * the least value of its colours, and is clear where its value is lower. */
void hl_lay_slice_over(size_t below, hl_transfer_function *function);

/* Gives the picture of a slice a black background, and the exposure at which the colours of several volumes
 * of values add up. */
void hl_compose_slice(const hl_composer *composer, hl_scene_description *description);

#endif
