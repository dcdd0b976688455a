/* volume/formats/tiff/tiff_imagej.h - reads the colours and the windows of channels from a private tag of
 * ImageJ. */
#ifndef HL_VOLUME_TIFF_IMAGEJ_H
#define HL_VOLUME_TIFF_IMAGEJ_H

#include "volume/formats/tiff/tiff_file.h"
#include "volume/volume.h"

enum { TIFF_IMAGEJ_CHANNELS_MOST = 64 };

/* Reads the colours and windows of the channels, in order, from the current page. The tag's names of channels
 * are not read. channels: [TIFF_IMAGEJ_CHANNELS_MOST]. Returns the number of channels; 0 if the page lacks
 * the tag, or if the tag is damaged. */
size_t tiff_imagej_channels(const tiff_file *file, hl_channel *channels);

#endif
