/* volume/volume.h - defines the members of hl_volume, and functions for the library's own use.
 *
 * Voxels are kept as u8, u16 or f32 in native byte order. Signed integers of 8 and 16 bits are stored with
 * their sign bit flipped, and value_offset compensates for it. Values of all other types become f32. */
#ifndef HL_VOLUME_VOLUME_H
#define HL_VOLUME_VOLUME_H

#include <stdatomic.h>
#include <stdbool.h>

#include <halflight/volume.h>

#include "core/vector.h"

enum { HL_SERIES_TEXT_BYTES = 66 };

typedef enum hl_storage { HL_STORAGE_U8 = 0, HL_STORAGE_U16 = 1, HL_STORAGE_F32 = 2 } hl_storage;

/* An array of the file that a volume was loaded from. */
typedef struct hl_array_entry {
  char *name; /* owned */
  size_t components;
  hl_voxel_type type; /* 0 for a type that cannot be read */
  bool of_cells;
  bool is_id; /* whether the file says that the array numbers its points or cells */
} hl_array_entry;

/* The numbers of time steps, channels and resolutions of a file, each at least 1, and the indices of the time
 * step, the channel and the resolution that are read. */
typedef struct hl_selection {
  size_t times, channels, levels;
  int time, channel, level;
  int aim; /* the resolution that would be read if a first picture did not need only a coarser resolution */
} hl_selection;

/* The resolutions of the file from which a volume was loaded. */
enum { HL_RESOLUTIONS_MOST = 32 };
typedef struct hl_resolutions {
  bool is_chosen;                      /* whether the caller has named the resolution that is read */
  bool is_part;                        /* whether voxels out of sight were interpolated (beyond.h) */
  int finest;                          /* the finest resolution that is read if the caller names no
                                        * resolution */
  size_t longest[HL_RESOLUTIONS_MOST]; /* the number of voxels along the longest axis of each resolution; 0 if
                                        * the number is unknown */
} hl_resolutions;

/* The number of chunks of a store on a server, and the number of chunks for which the server has no file. */
typedef struct hl_absence {
  size_t absent, chunks; /* 0 if the file is not a store on a server */
} hl_absence;

/* One of the DICOM series in the input of a volume. All texts are printable. */
typedef struct hl_series_entry {
  char uid[HL_SERIES_TEXT_BYTES], modality[HL_SERIES_TEXT_BYTES], description[HL_SERIES_TEXT_BYTES];
  double number; /* NAN if absent */
  size_t dimensions[3];
} hl_series_entry;

/* The facts that a file states about one of its channels. */
enum { HL_CHANNEL_NAME_BYTES = 128 };
typedef struct hl_channel {
  char name[HL_CHANNEL_NAME_BYTES]; /* printable; "" if absent */
  bool has_color;
  double srgb[3];
  double window[2]; /* data values that are to be shown black and at full brightness; two equal values if the
                     * file does not state them */
} hl_channel;

/* A named label of a segmentation. */
enum { HL_SEGMENT_NAME_BYTES = 128, HL_MOST_SEGMENTS = 4096, HL_LABEL_MAP_BYTES = 256 };
typedef struct hl_segment {
  char name[HL_SEGMENT_NAME_BYTES];
  int64_t value;
  double srgb[3];
  bool has_color;
  int layer; /* index of the component that holds the label's voxels */
} hl_segment;

struct hl_volume {
  hl_context *context;
  atomic_int references;
  size_t dimension[3]; /* number of voxels along i, j, k */
  hl_storage storage;
  const void *voxels; /* [k][j][i]; stored values; owned unless borrowed; null if the volume has pages or
                       * bricks. The voxels of a row are adjacent; rows and slices of borrowed voxels may have
                       * gaps between them */
  size_t row_bytes, slice_bytes; /* number of bytes from one row to the next, and from one slice to the
                                  * next */
  void *exact; /* owned; [k][j][i]; the file's own numbers, of `type`, if the stored floats round any of them
                * (exact.h); null if the stored values are these numbers */
  unsigned char *colors;      /* owned; [k][j][i][4] (colors.h); null if colours come from the transfer
                               * function */
  signed char *slopes;        /* owned; [k][j][i][4]; slopes of a mask's lattice (label/mask.h); null for
                               * other volumes */
  double slope_scale;         /* for a mask's lattice: the slope, per voxel, that a stored slope of 1 stands
                               * for */
  uint32_t (*mask_bricks)[2]; /* owned; bricks of a mask's lattice (label/mask.h); null for other volumes */
  struct hl_pages *pages;     /* owned (pages.h); pages of voxels in a scratch file, over ranks, or sparse in
                               * memory; null if voxels are in one array */
  struct hl_volume *gathered; /* owned (store/gathered.h); for a label map over ranks: a copy of the whole map
                               * in memory; null until labels are needed */
  struct hl_bricks *bricks;   /* owned (bricks/bricks.h, in_bricks.h); the field, if it is in bricks; null for
                               * a volume of voxels. Values at voxels are computed from the field when
                               * needed */
  struct hl_volume *continued; /* owned; for a mesh of cells: the field continued beyond the mesh's walls;
                                * null for other volumes */
  struct hl_volume *wall; /* owned; for a mesh of cells: the depths, behind the mesh's walls, of the points of
                           * the lattice of `continued`. A depth clamped to 0 .. 1 is the fraction of matter
                           * at a position */
  hl_volume_field_error field_error; /* for a field in bricks: the greatest difference between the field and
                                      * its source; its `kind` is null if the difference is unknown */
  void *owned_voxels;                /* the block that is released with the volume; null if borrowed */
  void (*release)(void *release_data, const void *voxels); /* called when the volume no longer uses borrowed
                                                            * voxels; may be null */
  void *release_data;
  double value_scale; /* data value = value_scale * stored + value_offset */
  double value_offset;
  affine3 index_to_world; /* the map from indices to the world; voxel centres have integer indices */
  hl_voxel_type type;     /* type of the voxels in the file */
  hl_space space;
  const char *unit; /* unit of lengths in the world, static; null if unknown */
  hl_absence absence;
  bool is_anatomical; /* whether the file's `space` can be trusted, as in DICOM and NIfTI files. Programs that
                       * write other formats often state left-posterior-superior for any data */
  bool says_labels;   /* whether the file says that its values are labels */
  bool says_fog;      /* whether the file says that its values are the density of a fog */
  double window[2];   /* the data values that the file asks to show black and white; NAN if the file asks for
                       * none */
  double minimum, maximum; /* least and greatest data value of finite voxels */
  uint64_t whole_range[2]; /* range of the file's numbers, as 64-bit integers of `type`; set if doubles would
                            * round the numbers (hl_volume_is_exact()) */
  double mean;
  uint64_t nonfinite_count;
  uint64_t histogram[HL_HISTOGRAM_BINS];
  hl_array_entry *arrays; /* owned; [array_count]; the file's arrays; null unless the volume was loaded from a
                           * file */
  size_t array_count, chosen_array;
  int component; /* index of the component that was read, or HL_COMPONENT_MAGNITUDE */
  hl_selection selection;
  hl_resolutions resolutions;
  hl_channel *channels;    /* owned; [selection.channels]; null if the file does not describe channels */
  hl_series_entry *series; /* owned; [series_count]; null unless the volume was loaded from DICOM files */
  size_t series_count, chosen_series;
  hl_segment *segments; /* owned; [segment_count]; null unless the file names labels */
  size_t segment_count;
  char (*label_maps)[HL_LABEL_MAP_BYTES]; /* owned; [label_map_count]; printable paths within the file */
  size_t label_map_count;
  bool has_surroundings; /* whether `surroundings`, the data value around the content, is known */
  double surroundings;
  bool is_log_density;          /* whether values are logarithms of a density of particles (particles.c) */
  double smoothing;             /* standard deviation, in voxels, of the Gaussian with which the voxels were
                                 * smoothed (guess/smoothing.c) */
  struct hl_volume *unsmoothed; /* owned (unsmoothed.h); the volume before the smoothing; null if the
                                 * unsmoothed volume is not kept, and for volumes that were not smoothed */
  atomic_bool smoothing_chosen; /* whether the volume was made by hl_volume_smooth(), even if its voxels did
                                 * not change */
  double surface_slope;         /* if values are an occupancy: the slope, per voxel, of the values where they
                                 * are 1/2; else 0 */
  _Atomic(struct hl_data_analysis *) analysis; /* owned, in one block; the results of guess/analysis.h; null
                                                * until the results are needed */
  /* Data that other parts of the library keep with the volume. The volume owns the data of its shelf, and
   * releases the data. */
  atomic_flag shelf_lock; /* held while `scraps` and the shelf are accessed */
  void *shelf;
  void (*release_shelf)(hl_context *context, void *shelf);
  struct hl_kept_scraps *scraps; /* owned (scraps.h); the last result of hl_scraps_hide(); null before its
                                  * first call */
};

static inline size_t hl_storage_bytes(hl_storage storage) {
  return storage == HL_STORAGE_U8 ? 1 : storage == HL_STORAGE_U16 ? 2 : 4;
}
static inline size_t hl_volume_voxel_count(const hl_volume *volume) {
  return volume->dimension[0] * volume->dimension[1] * volume->dimension[2];
}

/* Returns whether voxels are in memory without gaps between rows and slices. */
static inline bool hl_volume_is_packed(const hl_volume *volume) {
  size_t row = volume->dimension[0] * hl_storage_bytes(volume->storage);
  return volume->voxels != NULL && volume->row_bytes == row &&
         volume->slice_bytes == row * volume->dimension[1];
}

/* The first voxel of a row of a volume whose voxels are in memory (voxels is not null). */
static inline const void *hl_volume_row(const hl_volume *volume, size_t j, size_t k) {
  return (const unsigned char *)volume->voxels + k * volume->slice_bytes + j * volume->row_bytes;
}

/* The first voxel of a row of any volume. If the voxels are not in memory, the row is copied to `buffer`,
 * which must have room for a row. */
const void *hl_volume_row_in(const hl_volume *volume, size_t j, size_t k, void *buffer);

/* Does what hl_volume_value() does, for functions of the library that are called behind a door
 * (core/door.h). */
double hl_volume_value_within(const hl_volume *volume, size_t i, size_t j, size_t k);
/* Interpolates a volume linearly along the three axes at a position in its index space. Beyond the outermost
 * voxels, the values of these voxels continue. Voxels whose weight is 0 are not read, so that at the centre
 * of a voxel the result is exactly the voxel's value. As for hl_volume_value_within(), the caller must have
 * passed a door. */
double hl_volume_value_between(const hl_volume *volume, const double at[3]);

/* The number at index i of a row of stored values. */
static inline double hl_stored_number(hl_storage storage, const void *row, size_t i) {
  if (storage == HL_STORAGE_U8) return ((const uint8_t *)row)[i];
  if (storage == HL_STORAGE_U16) return ((const uint16_t *)row)[i];
  return (double)((const float *)row)[i];
}

/* A row of numbers. The numbers are the file's own numbers if the stored values round any of the file's
 * numbers, else the stored values. */
typedef struct hl_number_row {
  hl_voxel_type type; /* type of the numbers: U8, U16, F32, or a type of exact.h */
  const void *numbers;
} hl_number_row;

/* The size in bytes of a buffer for rows of numbers. */
size_t hl_volume_row_room(const hl_volume *volume);

/* Gives a row of numbers of any volume. Data value = value_scale * number + value_offset. buffer:
 * hl_volume_row_room() bytes, aligned for doubles; used if the numbers are not in memory. */
hl_number_row hl_volume_numbers(const hl_volume *volume, size_t j, size_t k, void *buffer);
/* Returns whether the stored values round some of the file's own numbers, so that the volume also keeps the
 * file's own numbers. */
bool hl_volume_is_exact(const hl_volume *volume);
double hl_row_number(hl_number_row row, size_t i);

/* Returns whether two voxels of a row have the same number. */
static inline bool hl_row_repeats(hl_number_row row, size_t a, size_t b) {
  switch (row.type) {
    case HL_VOXEL_U8: return ((const uint8_t *)row.numbers)[a] == ((const uint8_t *)row.numbers)[b];
    case HL_VOXEL_U16: return ((const uint16_t *)row.numbers)[a] == ((const uint16_t *)row.numbers)[b];
    case HL_VOXEL_U64:
    case HL_VOXEL_I64:
    case HL_VOXEL_F64: return ((const uint64_t *)row.numbers)[a] == ((const uint64_t *)row.numbers)[b];
    default: return ((const uint32_t *)row.numbers)[a] == ((const uint32_t *)row.numbers)[b];
  }
}

/* Finds a data value of a row as a whole number, such as a label, without rounding the value to a double.
 * Returns false if the value is not a whole number that int64_t holds. */
bool hl_row_whole(const hl_volume *volume, hl_number_row row, size_t i, int64_t *whole);

/* The result of hl_volume_whole() for a voxel. */
typedef enum hl_whole {
  HL_WHOLE_ABSENT, /* the voxel is outside the grid, or its value is not finite */
  HL_WHOLE_FRACTION,
  HL_WHOLE_FOUND
} hl_whole;

/* Finds the data value of a voxel as a whole number, as hl_row_whole() does, in a volume of any kind. */
hl_whole hl_volume_whole(const hl_volume *volume, size_t i, size_t j, size_t k, int64_t *whole);

/* The description of a volume's grid: dimensions, axes, origin and space. The other members of the
 * description have their defaults. */
hl_volume_description hl_volume_own_grid(const hl_volume *volume);

/* Copies properties that a description does not hold to a volume on the grid of another volume: the exact map
 * from indices to the world, and the facts that the file states about the voxels, the channels and the
 * series. Arrays and segments are not copied. Fails only if memory is short. */
hl_status hl_volume_take_about(hl_volume *volume, const hl_volume *from, hl_error *error);

/* Makes a volume of packed voxels that are already in stored form (hl_voxels_store()), in a block of
 * hl_allocate() that the volume takes over, also on failure. description: the grid, the type in the file, and
 * value_scale and value_offset, which apply to values of this type. subject: starts the error lines. */
hl_status hl_volume_adopt(hl_context *context, const hl_volume_description *description, const char *subject,
                          void *voxels, hl_volume **volume, hl_error *error);

/* Makes a volume as hl_volume_adopt() does. The volume also takes over the file's own numbers, which
 * hl_exact_take() has given. */
hl_status hl_volume_adopt_exact(hl_context *context, const hl_volume_description *description,
                                const char *subject, void *voxels, void *exact, hl_volume **volume,
                                hl_error *error);

/* Makes a volume as hl_volume_adopt() does, of voxels in pages. The volume takes over the pages, also on
 * failure. */
hl_status hl_volume_adopt_pages(hl_context *context, const hl_volume_description *description,
                                const char *subject, struct hl_pages *pages, hl_volume **volume,
                                hl_error *error);

/* Releases a list of arrays. */
void hl_arrays_release(hl_context *context, hl_array_entry *arrays, size_t count);

/* Checks type, dimensions, the volume's size in bytes, axes, scale and offset. Fails if any of these
 * properties is impossible. */
hl_status hl_volume_check_grid(const hl_volume_description *description, const char *subject,
                               hl_error *error);

#endif
