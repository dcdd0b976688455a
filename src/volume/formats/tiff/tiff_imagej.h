/* volume/formats/tiff/tiff_imagej.h - reads the colours and windows of channels, which ImageJ keeps in a tag
 * of its own. */
#ifndef HL_VOLUME_TIFF_IMAGEJ_H
#define HL_VOLUME_TIFF_IMAGEJ_H

#include "volume/formats/tiff/tiff_file.h"
#include "volume/volume.h"

enum { TIFF_IMAGEJ_CHANNELS_MOST = 64 };

/* Reads the channels of the file's current page, in order, without names. channels:
 * [TIFF_IMAGEJ_CHANNELS_MOST]. Returns the number of channels; 0 if the page has no such tag, or a damaged
 * one. */
size_t tiff_imagej_channels(const tiff_file *file, hl_channel *channels);

#endif
