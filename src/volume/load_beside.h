/* volume/load_beside.h - loads a label map that lies over a volume. */
#ifndef HL_VOLUME_LOAD_BESIDE_H
#define HL_VOLUME_LOAD_BESIDE_H

#include <halflight/volume.h>
#include <stdbool.h>

/* Finds the spacing of label maps over a volume whose own files tell none. stated: the spacing that the user
 * has stated for the volume; 0 if there is none. If none was stated, it is the volume's own spacing. */
void hl_spacing_beside(const hl_volume *volume, const double stated[3], double spacing[3]);

/* Returns whether a label map that was read by its own spacing takes the spacing of hl_spacing_beside(). It
 * has the same number of voxels along each axis as the volume. And either the user has stated the volume's
 * spacing, because files of bare voxels tell none, or the map's file tells neither a spacing nor a unit. */
bool hl_takes_spacing_beside(const hl_volume *map, const hl_volume *volume, const double stated[3]);

/* Returns whether a label map takes the anatomical space that the user has stated for the volume (null:
 * none). It does if its own file tells no space. */
bool hl_takes_space_beside(const hl_volume *map, const char *stated_space);

/* Loads a label map as hl_volume_load_with() does, with the spacing of hl_spacing_beside() and the stated
 * space if the map takes them. volume: may be null. options->spacing and options->file_space are set to those
 * by which the map was read; those that they have already stay. Warns if none of the map lies in the volume's
 * box. */
hl_status hl_volume_load_beside(hl_context *context, const char *path, const hl_volume *volume,
                                const double stated[3], const char *stated_space,
                                hl_volume_load_options *options, hl_volume **map, hl_error *error);

#endif
