/* halflight/volume.h - a regular grid of scalar voxels, placed in the world.
 *
 * Voxel (i, j, k) has its centre at world = origin + i*axis[0] + j*axis[1] + k*axis[2]; i runs
 * fastest in memory. Volumes are immutable and reference-counted: hl_volume_retain() and hl_volume_release().
 */
#ifndef HALFLIGHT_VOLUME_H
#define HALFLIGHT_VOLUME_H

#include "context.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum hl_voxel_type {
  HL_VOXEL_U8 = 1,
  HL_VOXEL_I8 = 2,
  HL_VOXEL_U16 = 3,
  HL_VOXEL_I16 = 4,
  HL_VOXEL_U32 = 5,
  HL_VOXEL_I32 = 6,
  HL_VOXEL_F32 = 7,
  HL_VOXEL_F64 = 8,
  HL_VOXEL_U64 = 9, /* pictures round integers of 32 and 64 bits and doubles to floats, which have 24
                     * significant bits. Labels, masks, hl_volume_value(), the range and hl_volume_save() keep
                     * whole numbers exactly */
  HL_VOXEL_I64 = 10,
  HL_VOXEL_F16 = 11 /* IEEE 754 binary16, kept as float */
} hl_voxel_type;

typedef struct hl_volume hl_volume;

/* Which way the world's axes x, y, z point in a patient's body, if the file says this. */
typedef enum hl_space {
  HL_SPACE_UNKNOWN = 0,
  HL_SPACE_RAS = 1, /* the axes point to the body's right, front (anterior) and head (superior), as in
                     * NIfTI */
  HL_SPACE_LPS = 2, /* left, back (posterior), head: DICOM */
  HL_SPACE_LAS = 3  /* left, front, head: left-handed */
} hl_space;

/* How voxels lie in the caller's memory and in the world. */
typedef struct hl_volume_description {
  size_t struct_size;        /* set by hl_volume_description_defaults() */
  size_t dimensions[3];      /* voxels along i, j, k; each at least 1 */
  hl_voxel_type type;        /* native byte order */
  double origin[3];          /* world position of the centre of voxel (0,0,0); default 0 */
  double axis[3][3];         /* axis[a]: world step of one voxel along index axis a; default unit */
  double value_scale;        /* data value = value_scale * stored + value_offset; default 1 */
  double value_offset;       /* default 0 */
  const void *voxels;        /* voxel (0,0,0) */
  ptrdiff_t stride_bytes[3]; /* bytes from one voxel to the next along i, j, k; all 0: packed */
  /* Non-zero: u8, u16 and f32 voxels are not copied, and must outlive the volume. The voxels of a row must be
   * adjacent. There may be gaps between rows and between slices, which must lie in rising order; from one
   * slice to the next are at most 64 MiB. The voxels must not change, because the range, the histogram, the
   * empty places and a renderer's tables are computed only once. If voxels change nevertheless, pictures show
   * new voxels in some places and old ones in others, and a pixel may be any number or NaN. Even then no call
   * reads or writes other memory, and every call ends. For new voxels make a new volume. */
  int borrow;
  hl_space space; /* default unknown */
  /* Called once, when the library no longer reads `voxels`. For borrowed voxels this is when the volume's
   * last reference is released, by the thread that releases it. For copied voxels it is before
   * hl_volume_create() returns. Not called if hl_volume_create() fails. Default null. */
  void (*release)(void *release_data, const void *voxels);
  void *release_data; /* for `release` */
} hl_volume_description;

#define HL_HISTOGRAM_BINS 256

/* Facts about a volume. All values are data values (scale and offset applied). */
typedef struct hl_volume_info {
  size_t struct_size; /* set by the caller to sizeof(hl_volume_info) */
  size_t dimensions[3];
  hl_voxel_type type; /* as in the file */
  double spacing[3];  /* length of each axis, world units */
  double origin[3];
  double direction[3][3];   /* direction[row][column]; columns are the unit axes */
  double range[2];          /* least and greatest finite value; 0, 0 if there is none. For a mesh of cells or
                             * an adaptive grid it is the range of the spline's coefficients; near a face, the
                             * field's values may lie beyond this range */
  double mean;              /* over finite voxels */
  uint64_t nonfinite_count; /* NaN and infinite voxels: transparent when rendered */
  uint64_t histogram[HL_HISTOGRAM_BINS]; /* equal bins over range, finite voxels */
  hl_space space;
} hl_volume_info;

HL_API const char *hl_space_name(hl_space space); /* "RAS"; null where it is unknown */
HL_API void hl_volume_description_defaults(hl_volume_description *description);

/* Voxels are copied unless description->borrow. *volume is owned by the caller (release it). */
HL_API HL_WARN_UNUSED hl_status hl_volume_create(hl_context *context,
                                                 const hl_volume_description *description, hl_volume **volume,
                                                 hl_error *error);

/* Reads a volume file: raw (by name), NRRD, MetaImage, NIfTI, VTK .vti, legacy .vtk, NumPy .npy (axes
 * [z][y][x]), MRC, TIFF, NanoVDB, OpenVDB (by the context's `convert`) and DICOM files, and folders and zip
 * archives of DICOM files or of Zarr arrays (OME-Zarr). Particles are read from tables, dumps of LAMMPS and
 * XYZ files; the volume's values are then log10 of their density (halflight/particles.h). The format is
 * recognised by the file's content, or by its name where the content has no mark. Where a file has several
 * arrays or components, one is read by default (hl_volume_load_options), and a warning says which. */
HL_API HL_WARN_UNUSED hl_status hl_volume_load(hl_context *context, const char *path, hl_volume **volume,
                                               hl_error *error);

/* Instead of the index of a component. */
enum {
  HL_COMPONENT_DEFAULT = -1,   /* the default: the file's only component; else all of them as colours, if the
                                * file says that they are colours; else the magnitude of vectors of 2 or 3
                                * components; else the first component */
  HL_COMPONENT_MAGNITUDE = -2, /* the square root of the sum of squares, as float */
  /* Three or four components (unsigned, 8 or 16 bits) are the voxels' own colours: red, green, blue (sRGB),
   * alpha. Colours are kept in 8 bits and multiply the transfer function's colours. The volume's values,
   * which opacity comes from, are the alpha. Where there is no alpha, or alpha is the same everywhere, the
   * values are the luminance (luma with BT.709's weights). */
  HL_COMPONENT_COLOR = -3,
  HL_COMPONENT_LUMINANCE = -4 /* and the luminance in any case */
};

/* The name of an HL_COMPONENT_ value: "magnitude", "color" or "luminance"; null for an index and for the
 * default. */
HL_API const char *hl_component_name(int component);
/* The HL_COMPONENT_ value that a name of hl_component_name() stands for; HL_COMPONENT_DEFAULT for any other
 * text. */
HL_API int hl_component_of_name(const char *name);

/* Stands for an index that the caller does not choose: the first time step or channel. For a resolution it is
 * the finest one for which the memory limit leaves room, or a coarser one where the picture would not show
 * its detail (`pixels`). */
enum { HL_INDEX_DEFAULT = -1 };

typedef struct hl_volume_load_options {
  size_t struct_size; /* set by hl_volume_load_options_defaults() */
  const char *array;  /* the name of the array that is read, if the file has several; null: the array that the
                       * file calls active, else the first scalar array, else the first array */
  int component;      /* the component that is read: its number, from 0, or an HL_COMPONENT_ value; default
                       * HL_COMPONENT_DEFAULT. In a file with a series of volumes over time, each volume
                       * counts as a component */
  double spacing[3];  /* distance of voxels along i, j, k in world units, in place of the file's; all 0
                       * (default): the file's */
  const void *bytes;  /* the file's content in memory, borrowed during the call; no file is opened, and path
                       * is only a name. Default null */
  size_t byte_count;
  const char *series; /* the series that is read, of several. DICOM: a series' number, UID or description;
                       * null: the largest. OME-Zarr: an image's number, path or name; null: the first */
  hl_space space;     /* the anatomical space into which the volume's world is turned, if the file tells
                       * its own space; default unknown: the world is not turned */
  int time, channel, level; /* the time step, channel and resolution (0: the finest) that are read, of
                             * several; numbers from 0; default HL_INDEX_DEFAULT */
  int pixels; /* the longer side, in pixels, of a picture that the volume will fill; 0 (default): unknown.
               * Of several resolutions, the coarsest is read whose longest axis has at least as many
               * voxels. Unused where `level` is given */
  int preview_pixels; /* above 0: of several resolutions, a coarser one is read for a first picture, whose
                       * longer side has this many pixels. hl_volume_selection.aim is then the resolution that
                       * would be read without this option. Default 0 */
} hl_volume_load_options;

HL_API void hl_volume_load_options_defaults(hl_volume_load_options *options);

/* Reads a volume as hl_volume_load() does, with options (null: the defaults). If the file does not have the
 * array or component, the error is HL_ERROR_INPUT, and its message lists the file's arrays or components. */
HL_API HL_WARN_UNUSED hl_status hl_volume_load_with(hl_context *context, const char *path,
                                                    const hl_volume_load_options *options, hl_volume **volume,
                                                    hl_error *error);

/* How a volume is written. */
typedef struct hl_volume_save_options {
  size_t struct_size; /* set by hl_volume_save_options_defaults() */
  hl_voxel_type type; /* type of the written voxels; 0 (default): the volume's own type if it holds all data
                       * values and the format has it; else the smallest integer type that holds all of them;
                       * else float */
  size_t begin[3], end[3]; /* the voxels begin[a] <= index < end[a] along axis a are written; end 0 (default):
                            * up to the last */
  size_t shrink; /* a written voxel is the mean of shrink^3 voxels, without those that are not finite;
                  * default 1 */
  int labels;    /* non-zero: the volume holds labels, and a mean of labels would be another label. A written
                  * voxel then has the commonest value of the shrink^3 voxels; of equally common values, the
                  * first one. Default 0 */
} hl_volume_save_options;

HL_API void hl_volume_save_options_defaults(hl_volume_save_options *options);

/* Writes .nrrd (gzip), .nii, .nii.gz, .mha (zlib), .vti, .mrc, .mrc.gz, .raw or .raw.gz, by the name's
 * ending; the name of a raw file must state size and type, as for reading. Data values and placement are
 * kept. For NIfTI and MetaImage, the world is converted to the format's anatomical space. A grid that MRC
 * cannot hold is refused. Where the type holds whole numbers, values are rounded to the nearest, and values
 * that are not finite become 0. Warnings tell how many values were beyond the type's range or not finite, and
 * which parts of the placement the format cannot state. options: null: the defaults. The file appears whole
 * or not at all. */
HL_API HL_WARN_UNUSED hl_status hl_volume_save_with(hl_context *context, const hl_volume *volume,
                                                    const char *path, const hl_volume_save_options *options,
                                                    hl_error *error);

/* hl_volume_save_with() the defaults. */
HL_API HL_WARN_UNUSED hl_status hl_volume_save(hl_context *context, const hl_volume *volume, const char *path,
                                               hl_error *error);

/* Makes a volume whose voxels are smoothed by a Gaussian. sigma: the standard deviation, from 0 to 16, in
 * voxels of each axis, also of an axis with thick slices. With 0 the volume is not smoothed, and
 * hl_scene_for_volume() does not smooth it either. Smoothed values are floats. Label maps, volumes with
 * colours and volumes larger than memory are refused. *smoothed is owned by the caller (release it). */
HL_API HL_WARN_UNUSED hl_status hl_volume_smooth(hl_volume *volume, double sigma, hl_volume **smoothed,
                                                 hl_error *error);

/* The standard deviation, in voxels, of the Gaussian that smoothed the volume's voxels; 0: they were not
 * smoothed, or the volume is null. */
HL_API double hl_volume_smoothing(const hl_volume *volume);

/* The volume with the values that a smoothed volume's voxels had before they were smoothed: those of its
 * file. It has the same grid. Null if the volume is null or not smoothed, or if its context keeps no such
 * volumes (hl_context_options.keep_unsmoothed). It belongs to `volume`, and is valid as long as `volume` is.
 */
HL_API const hl_volume *hl_volume_unsmoothed(const hl_volume *volume);

HL_API void hl_volume_retain(hl_volume *volume);
HL_API void hl_volume_release(hl_volume *volume); /* null is allowed */

HL_API HL_WARN_UNUSED hl_status hl_volume_get_info(const hl_volume *volume, hl_volume_info *info);

/* How much the field of a volume differs from its file. Meshes of cells, grids with refinement, sparse
 * grids and particles become a field when they are loaded. Other volumes keep the file's voxels. */
typedef struct hl_volume_field_error {
  size_t struct_size; /* set by the caller */
  double value;       /* the difference in data values; NaN: nothing could be compared, as in a mesh of one
                       * layer of cells */
  double
      of_range; /* `value` divided by the width of the volume's range of values; NaN where `value` is NaN */
  const char *kind; /* "exact": somewhere the difference is as great as `value`; "bound": the differences
                     * may all be smaller; "sampled": `value` is the greatest difference at a few thousand
                     * places, and other places may have greater ones. A constant text */
  const char
      *source; /* what the field was compared with, in words: "the means over the cells". A constant text */
} hl_volume_field_error;

/* Finds how much a volume's field differs from its file. For a mesh of cells this is a bound of the
 * difference between the field and the values that the cells interpolate, at places where the field does
 * not depend on anything outside the mesh. For a grid with refinement it is the greatest difference between
 * a cell's value and the field's mean over the cell. For a sparse grid it is 0, since the field equals that
 * of the dense grid. For particles it is the greatest difference from the exact sum of the kernels at the
 * places of up to 4,096 particles. Where the volume keeps the file's voxels, the call fails with
 * HL_ERROR_ARGUMENT, and sets nothing. */
HL_API HL_WARN_UNUSED hl_status hl_volume_get_field_error(const hl_volume *volume,
                                                          hl_volume_field_error *field_error);

/* The box around a volume's voxels, half a voxel beyond the centres of the outermost voxels, in the world of
 * its file: least and greatest x, y, z. Where one of the pointers is null, nothing is done. */
HL_API void hl_volume_world_box(const hl_volume_info *info, double low[3], double high[3]);

/* The unit of lengths in the volume's world, as the volume's file tells it: "metre", "millimetre",
 * "micrometre" or "angstrom"; null where it is unknown. A constant text. */
HL_API const char *hl_volume_unit(const hl_volume *volume);

/* The number of chunks of a store on a server for which the server has no file, so that their voxels have the
 * fill value; 0 for other volumes. *chunks receives the number of chunks of which the volume consists; may be
 * null. */
HL_API size_t hl_volume_absent_chunks(const hl_volume *volume, size_t *chunks);

/* An array of the file that a volume was loaded from. */
typedef struct hl_volume_array {
  size_t struct_size; /* set by the caller */
  const char *name;   /* "" where the format has no names; the text belongs to the volume */
  size_t components;  /* values per voxel, or volumes of a series */
  hl_voxel_type type; /* 0: a type that cannot be read */
  int of_cells;       /* VTK: values between the points */
  int chosen;         /* the volume was read from this array */
  int component;      /* for the array that was read: the number of the component that was read, or an
                       * HL_COMPONENT_ value; HL_COMPONENT_LUMINANCE for colours whose luminance gives the
                       * opacity */
} hl_volume_array;

/* The number of arrays in the volume's file (arrays beyond 256 are not counted); 0: the volume came from
 * memory or shapes. */
HL_API size_t hl_volume_array_count(const hl_volume *volume);
HL_API HL_WARN_UNUSED hl_status hl_volume_get_array(const hl_volume *volume, size_t index,
                                                    hl_volume_array *array);

/* Finds percentiles of the finite voxels' data values: each of `percents` is from 0 to 100. The values are
 * exact; between two voxels that follow each other in order they are interpolated, as by numpy.percentile().
 * They are 0 where no voxel is finite. values: [count]. Reads all voxels. */
HL_API HL_WARN_UNUSED hl_status hl_volume_percentiles(const hl_volume *volume, const double *percents,
                                                      size_t count, double *values, hl_error *error);

/* The numbers of time steps, channels and resolutions that the volume's file has, each at least 1, and
 * which of them were read. */
typedef struct hl_volume_selection {
  size_t struct_size; /* set by the caller */
  size_t times, channels, levels;
  int time, channel, level;
  int aim; /* the resolution that the options of reading ask for; another one than `level` if a coarser one
            * was read for a first picture (hl_volume_load_options.preview_pixels) */
} hl_volume_selection;

HL_API HL_WARN_UNUSED hl_status hl_volume_get_selection(const hl_volume *volume,
                                                        hl_volume_selection *selection);

/* A channel of a file with several channels, as the file describes it. */
typedef struct hl_volume_channel {
  size_t struct_size; /* set by the caller */
  const char *name;   /* "" where the file has none; the volume's */
  int has_color;
  double srgb[3];   /* 0 to 1; 0 without a colour */
  double window[2]; /* the range of data values that the file asks to show; NaN: it asks for none */
  int chosen;       /* the volume was read from this channel */
} hl_volume_channel;

/* Describes a channel of the volume's file. index: below the number of channels (hl_volume_get_selection()).
 * Where the file does not describe its channels, they have neither names nor colours nor windows. */
HL_API HL_WARN_UNUSED hl_status hl_volume_get_channel(const hl_volume *volume, size_t index,
                                                      hl_volume_channel *channel);

/* A series of DICOM slices: one of those in a folder or an archive. */
typedef struct hl_volume_series {
  size_t struct_size;                       /* set by the caller */
  const char *uid, *modality, *description; /* "" where the files have none; the texts belong to the volume */
  double number;                            /* NaN: none */
  size_t dimensions[3];                     /* columns, rows, slices of all its times */
  int chosen;                               /* the volume was read from this series */
} hl_volume_series;

/* The number of series in the input; 0: the volume came from other files or from memory. */
HL_API size_t hl_volume_series_count(const hl_volume *volume);
HL_API HL_WARN_UNUSED hl_status hl_volume_get_series(const hl_volume *volume, size_t index,
                                                     hl_volume_series *series);

/* A segment of a label map, as its file names it. */
typedef struct hl_volume_segment {
  size_t struct_size; /* set by the caller */
  const char *name;   /* "" where the file has none; the volume's */
  int64_t value;      /* of its voxels */
  int layer;          /* the component, from 0, whose voxels have the value */
  int has_color;
  double srgb[3]; /* 0 to 1; 0 without a colour */
} hl_volume_segment;

/* The number of segments that the volume's file names; 0: it names none. */
HL_API size_t hl_volume_segment_count(const hl_volume *volume);
HL_API HL_WARN_UNUSED hl_status hl_volume_get_segment(const hl_volume *volume, size_t index,
                                                      hl_volume_segment *segment);

/* The path, within the volume's file, of label map number `index` that lies beside the volume there (the
 * "labels" of OME-Zarr), as "labels/cells". A label map is opened as a volume of its own. The text belongs to
 * the volume; null past the last. */
HL_API const char *hl_volume_label_map(const hl_volume *volume, size_t index);

enum { HL_NUMBER_TEXT_BYTES = 64 };

/* Writes the least (end 0) or the greatest (end 1) finite data value as a decimal number that reads back as
 * the same number. Whole numbers have all their digits, even numbers of 64 bits, which a double would round.
 * text: has room for HL_NUMBER_TEXT_BYTES bytes. */
HL_API HL_WARN_UNUSED hl_status hl_volume_write_range(const hl_volume *volume, int end, char *text);

/* The data value of one voxel, NaN where it is not finite or outside the grid. */
HL_API double hl_volume_value(const hl_volume *volume, size_t i, size_t j, size_t k);

/* "uint8", "int16", "float32", ... */
HL_API const char *hl_voxel_type_name(hl_voxel_type type);

#ifdef __cplusplus
}
#endif
#endif
