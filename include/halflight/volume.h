/* halflight/volume.h - a regular grid of scalar voxels, placed in the world.
 *
 * Voxel (i, j, k) has its centre at world = origin + i*axis[0] + j*axis[1] + k*axis[2]; i runs fastest in
 * memory. Volumes never change, and are reference-counted: hl_volume_retain() and hl_volume_release(). */
#ifndef HALFLIGHT_VOLUME_H
#define HALFLIGHT_VOLUME_H

#include "context.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The type of stored voxels. */
typedef enum hl_voxel_type {
  HL_VOXEL_U8 = 1,
  HL_VOXEL_I8 = 2,
  HL_VOXEL_U16 = 3,
  HL_VOXEL_I16 = 4,
  HL_VOXEL_U32 = 5,
  HL_VOXEL_I32 = 6,
  HL_VOXEL_F32 = 7,
  HL_VOXEL_F64 = 8,
  HL_VOXEL_U64 = 9, /* For pictures, integers of 32 and 64 bits and doubles are rounded to floats, which have
                     * 24 significant bits. Labels, masks, hl_volume_value(), the range and hl_volume_save()
                     * keep whole numbers exactly */
  HL_VOXEL_I64 = 10,
  HL_VOXEL_F16 = 11 /* IEEE 754 binary16; the library keeps these voxels as 32-bit floats */
} hl_voxel_type;

typedef struct hl_volume hl_volume;

/* Which way the world's axes x, y, z point in a patient's body, if the volume's file tells it. */
typedef enum hl_space {
  HL_SPACE_UNKNOWN = 0,
  HL_SPACE_RAS = 1, /* the axes point to the body's right, front (anterior) and head (superior), as in
                     * NIfTI */
  HL_SPACE_LPS = 2, /* the axes point to the body's left, back (posterior) and head, as in DICOM */
  HL_SPACE_LAS = 3  /* the axes point to the body's left, front and head; they are left-handed */
} hl_space;

/* The voxels of a volume: how they lie in the caller's memory and in the world. */
typedef struct hl_volume_description {
  size_t struct_size;        /* set by hl_volume_description_defaults() */
  size_t dimensions[3];      /* the number of voxels along i, j, k; each at least 1 */
  hl_voxel_type type;        /* native byte order */
  double origin[3];          /* world position of the centre of voxel (0,0,0); default 0 */
  double axis[3][3];         /* axis[a] is the step in the world from one voxel to the next along index axis
                              * a; default: the unit vectors */
  double value_scale;        /* data value = value_scale * stored + value_offset; default 1 */
  double value_offset;       /* default 0 */
  const void *voxels;        /* the address of voxel (0,0,0) */
  ptrdiff_t stride_bytes[3]; /* the number of bytes from one voxel to the next along i, j, k; all 0: the
                              * voxels are packed */
  /* Non-zero: u8, u16 and f32 voxels are not copied, and must outlive the volume. The voxels of a row must be
   * adjacent. There may be gaps between rows and between slices, but rows and slices must lie in rising
   * order, and one slice begins at most 64 MiB after the slice before it. The voxels must not change, because
   * the range, the histogram, the empty places and a renderer's tables are computed only once. If voxels
   * change nevertheless, pictures show new voxels in some places and old ones in others, and a pixel may be
   * any number or NaN. Even then no call reads or writes other memory, and every call ends. To show changed
   * voxels, make a new volume. */
  int borrow;
  hl_space space; /* default unknown */
  /* Called once, when the library no longer reads `voxels`. For borrowed voxels, the thread that releases the
   * volume's last reference makes this call. For copied voxels, the call comes before hl_volume_create()
   * returns. There is no call if hl_volume_create() fails. Default null. */
  void (*release)(void *release_data, const void *voxels);
  void *release_data; /* for `release` */
} hl_volume_description;

#define HL_HISTOGRAM_BINS 256

/* Facts about a volume. All values are data values (scale and offset applied). */
typedef struct hl_volume_info {
  size_t struct_size; /* set by the caller to sizeof(hl_volume_info) */
  size_t dimensions[3];
  hl_voxel_type type; /* the type of the voxels in the file */
  double spacing[3];  /* the length of each axis' step from voxel to voxel, in world units */
  double origin[3];
  double direction[3][3];   /* direction[row][column]: column a is the unit vector along index axis a */
  double range[2];          /* the least and the greatest finite value; 0, 0 if no value is finite. For a mesh
                             * of cells or an adaptive grid it is the range of the coefficients of the spline;
                             * near a face, values may lie beyond this range */
  double mean;              /* the mean of the finite voxels */
  uint64_t nonfinite_count; /* number of voxels that are NaN or infinite; they are transparent in pictures */
  uint64_t histogram[HL_HISTOGRAM_BINS]; /* the number of finite voxels in each of HL_HISTOGRAM_BINS equal
                                          * parts of the range */
  hl_space space;
} hl_volume_info;

HL_API const char *hl_space_name(hl_space space); /* the space's name, as "RAS"; null for HL_SPACE_UNKNOWN */
HL_API void hl_volume_description_defaults(hl_volume_description *description);

/* Makes a volume. Its voxels are copied unless description->borrow is set. *volume is owned by the caller,
 * who releases it. */
HL_API HL_WARN_UNUSED hl_status hl_volume_create(hl_context *context,
                                                 const hl_volume_description *description, hl_volume **volume,
                                                 hl_error *error);

/* Reads a volume file: raw (by name), NRRD, MetaImage, NIfTI, VTK .vti, legacy .vtk, NumPy .npy (axes
 * [z][y][x]), MRC, TIFF, NanoVDB, OpenVDB (by the context's `convert`) and DICOM files, and folders and zip
 * archives of DICOM files or of Zarr arrays (OME-Zarr). Particles are read from tables, dumps of LAMMPS and
 * XYZ files; the volume's values are then log10 of their density (halflight/particles.h). The format is
 * recognised by the file's content, or by its name where the content has no mark. If a file has several
 * arrays or components, hl_volume_load_options says which one is read by default, and a warning names it.
 * *volume is owned by the caller, who releases it. */
HL_API HL_WARN_UNUSED hl_status hl_volume_load(hl_context *context, const char *path, hl_volume **volume,
                                               hl_error *error);

/* Values that may be given in place of the index of a component. */
enum {
  HL_COMPONENT_DEFAULT = -1,   /* the default: the file's only component. If a file has several, all of them
                                * as colours if the file says that they are colours; else the magnitude if
                                * they are vectors of 2 or 3 components; else the first component */
  HL_COMPONENT_MAGNITUDE = -2, /* the square root of the sum of the components' squares, as float */
  /* Three or four components (unsigned, 8 or 16 bits) are the voxels' own colours: red, green, blue (sRGB),
   * alpha. Colours are kept in 8 bits and multiply the transfer function's colours. The volume's values,
   * which opacity comes from, are the alpha. Where there is no alpha, or alpha is the same everywhere, the
   * values are the luminance (luma with BT.709's weights). */
  HL_COMPONENT_COLOR = -3,
  HL_COMPONENT_LUMINANCE = -4 /* Colours, as for HL_COMPONENT_COLOR, but the values are the luminance even if
                               * there is an alpha */
};

/* Returns the name of an HL_COMPONENT_ value: "magnitude", "color" or "luminance". Returns null for an index
 * and for HL_COMPONENT_DEFAULT. */
HL_API const char *hl_component_name(int component);
/* Returns the HL_COMPONENT_ value with this name (hl_component_name()), or HL_COMPONENT_DEFAULT for any other
 * text. */
HL_API int hl_component_of_name(const char *name);

/* Stands for an index that the caller does not choose. It means the first time step or channel. For
 * resolutions, it means the finest one for which the memory limit leaves room, or a coarser one if the
 * picture would not show the finest one's detail (`pixels`). */
enum { HL_INDEX_DEFAULT = -1 };

typedef struct hl_volume_load_options {
  size_t struct_size; /* set by hl_volume_load_options_defaults() */
  const char *array;  /* the name of the array that is read, for a file with several arrays; null stands for
                       * the array that the file calls active, else the first scalar array, else the first
                       * array. Arrays that the file calls numbers of its points or cells come last */
  int component;      /* the component that is read: its number, from 0, or an HL_COMPONENT_ value; default
                       * HL_COMPONENT_DEFAULT. In a file with a series of volumes over time, each volume of
                       * the series counts as a component */
  double spacing[3];  /* the distances between voxels along i, j, k in world units, which replace the file's;
                       * all 0 (default): the file's distances */
  const void *bytes;  /* the file's content in memory, borrowed during the call; no file is opened, and path
                       * is only a name. Default null */
  size_t byte_count;
  const char *series; /* the series that is read from an input with several series. DICOM: a series' number,
                       * UID or description; null stands for the largest series. OME-Zarr: an image's number,
                       * path or name; null stands for the first image */
  hl_space space;     /* the anatomical space into which the volume's world is turned, if the file tells the
                       * space of its own world; default HL_SPACE_UNKNOWN: the world is not turned */
  int time, channel, level; /* the numbers, from 0, of the time step, the channel and the resolution (0: the
                             * finest) that are read; default HL_INDEX_DEFAULT */
  int pixels; /* the longer side, in pixels, of a picture that the volume will fill; 0 (default): unknown. Of
               * several resolutions, the library reads the coarsest whose longest axis has at least this
               * number of voxels. Not used if `level` is given */
  int preview_pixels; /* if above 0, a coarser one of several resolutions is read for a first picture, whose
                       * longer side has this number of pixels. hl_volume_selection.aim is then the resolution
                       * that would be read without this option. Default 0 */
  /* In place of `channel`: the name that the file gives the channel (OME, omero), or a number as text. A
   * number below the number of channels is never a name. Upper and lower case count only if they tell two
   * channels apart. Default null. */
  const char *channel_name;
  /* A coarser resolution of the same data, borrowed during the call. If it is given, chunks of a store that
   * none of the parts in `seen` touches are not read: their voxels are interpolated linearly in `coarse`.
   * Default null: all chunks are read. */
  const hl_volume *coarse;
  /* [seen_count], borrowed during the call; with `coarse`: what pictures see, each part as four planes
   * (hl_scene_seen_part()). A point p of the world lies inside of a part if a x + b y + c z + d >= 0 for each
   * of its planes a, b, c, d. */
  const double (*seen)[4][4];
  size_t seen_count;
  /* The directions in a patient's body to which x, y and z of the file's world point, as three letters in
   * this order: R or L, A or P, S or I. It replaces the file's own space, with a warning if the file tells
   * another one. For "RAS", "LPS" and "LAS" the world stays as it is. For all others, as "PIR" of sagittal
   * slices, the world is turned into RAS. Default null: the file's space. */
  const char *file_space;
} hl_volume_load_options;

HL_API void hl_volume_load_options_defaults(hl_volume_load_options *options);

/* Reads a volume as hl_volume_load() does, but with options for reading. If options is null, the defaults are
 * used. If the file does not have the array or component, the error is HL_ERROR_INPUT, and its message lists
 * the file's arrays or components. */
HL_API HL_WARN_UNUSED hl_status hl_volume_load_with(hl_context *context, const char *path,
                                                    const hl_volume_load_options *options, hl_volume **volume,
                                                    hl_error *error);

/* The options for writing a volume. */
typedef struct hl_volume_save_options {
  size_t struct_size; /* set by hl_volume_save_options_defaults() */
  hl_voxel_type type; /* the type of the written voxels. 0 (default): the volume's own type if it holds all
                       * data values and the format has it; else the smallest integer type that holds them;
                       * else float */
  size_t begin[3], end[3]; /* only the voxels with begin[a] <= index < end[a] along each axis a are written;
                            * end is 0, the default, for all voxels up to the last one */
  size_t shrink; /* a written voxel is the mean of a cube of shrink^3 voxels, without the voxels that are not
                  * finite; default 1 */
  int labels;    /* non-zero if the volume holds labels. A written voxel then has the most frequent value of
                  * its shrink^3 voxels instead of the mean, because a mean of labels would be another label.
                  * Of equally frequent values, the first one counts. Default 0 */
  const char *unit; /* the unit of lengths that is written if the volume's file does not tell one, by a name
                     * or symbol such as "mm" or "micrometre"; default null: none */
} hl_volume_save_options;

HL_API void hl_volume_save_options_defaults(hl_volume_save_options *options);

/* Writes a volume's file: .nrrd (gzip), .nii, .nii.gz, .mha (zlib), .vti, .mrc, .mrc.gz, .tif (a stack of
 * ImageJ), .npy (axes [k][j][i]), .raw or .raw.gz, by the name's ending; the name of a raw file must state
 * size and type, as for reading. Data values and placement are kept. For NIfTI and MetaImage, the world is
 * converted to the format's anatomical space. A grid that MRC cannot hold is refused. If the written type
 * holds whole numbers, values are rounded to the nearest one, and values that are not finite become 0.
 * Warnings tell the number of values that were beyond the type's range or not finite, and the parts of the
 * placement that the format cannot state. If options is null, the defaults. The file appears whole or not at
 * all. */
HL_API HL_WARN_UNUSED hl_status hl_volume_save_with(hl_context *context, const hl_volume *volume,
                                                    const char *path, const hl_volume_save_options *options,
                                                    hl_error *error);

/* Writes a volume's file as hl_volume_save_with() does, with the default options. */
HL_API HL_WARN_UNUSED hl_status hl_volume_save(hl_context *context, const hl_volume *volume, const char *path,
                                               hl_error *error);

/* Makes a volume whose voxels are smoothed by a Gaussian. sigma: the standard deviation, from 0 to 16. It is
 * counted in voxels along each axis, even if voxels are longer along one axis. With 0 the volume is not
 * smoothed, and hl_scene_for_volume() does not smooth it either. Smoothed values are floats. Label maps,
 * volumes with colours and volumes larger than memory are refused. *smoothed is owned by the caller (release
 * it). */
HL_API HL_WARN_UNUSED hl_status hl_volume_smooth(hl_volume *volume, double sigma, hl_volume **smoothed,
                                                 hl_error *error);

/* Returns the standard deviation, in voxels, of the Gaussian that smoothed the volume's voxels. Returns 0 if
 * the voxels were not smoothed, or if the volume is null. */
HL_API double hl_volume_smoothing(const hl_volume *volume);

/* Returns the volume from which a smoothed volume was made: the same grid with the values before the
 * smoothing. Returns null if the volume is null or not smoothed, or if its context keeps no such volumes
 * (hl_context_options.keep_unsmoothed). The result belongs to `volume`. */
HL_API const hl_volume *hl_volume_unsmoothed(const hl_volume *volume);

HL_API void hl_volume_retain(hl_volume *volume);
HL_API void hl_volume_release(hl_volume *volume); /* null is allowed */

HL_API HL_WARN_UNUSED hl_status hl_volume_get_info(const hl_volume *volume, hl_volume_info *info);

/* The difference between the field of a volume and its file. Meshes of cells, grids with refinement, sparse
 * grids and particles are converted to a field when they are loaded. Other volumes keep the file's voxels,
 * and have no such error. */
typedef struct hl_volume_field_error {
  size_t struct_size; /* set by the caller */
  double value;       /* the difference in data values; NaN: nothing could be compared, as for a mesh with
                       * only one layer of cells */
  double of_range;    /* `value` divided by the width of the values' range; NaN if `value` is NaN */
  const char *kind;   /* "exact": somewhere the difference is as great as `value`; "bound": the differences
                       * may all be smaller; "sampled": `value` is the greatest difference at a few thousand
                       * places, and other places may have greater ones. A constant text */
  const char *source; /* the data with which the field was compared, in words, as "the means over the cells".
                       * A constant text */
} hl_volume_field_error;

/* Finds how much a volume's field differs from its file. For a mesh of cells the error is a bound of the
 * difference between the field and the values that the cells interpolate. The bound holds where the field
 * does not depend on places outside the mesh. For a grid with refinement it is the greatest difference
 * between a cell's value and the field's mean over the cell. For a sparse grid it is 0, because the field is
 * the same as for the dense grid. For particles it is the greatest difference from the exact sum of the
 * kernels at the places of up to 4,096 particles. Where the volume keeps the file's voxels, the call fails
 * with HL_ERROR_ARGUMENT, and sets nothing. */
HL_API HL_WARN_UNUSED hl_status hl_volume_get_field_error(const hl_volume *volume,
                                                          hl_volume_field_error *field_error);

/* Finds the box around a volume's voxels in the world of its file: the least and the greatest x, y and z. The
 * box ends half a voxel beyond the centres of the outermost voxels. If one of the pointers is null, the
 * function does nothing. */
HL_API void hl_volume_world_box(const hl_volume_info *info, double low[3], double high[3]);

/* Returns the unit of length in the volume's world that the volume's file tells: "metre", "millimetre",
 * "micrometre" or "angstrom". Returns null if the unit is unknown. The text is constant. */
HL_API const char *hl_volume_unit(const hl_volume *volume);

/* Returns the number of absent chunks of a store on a server: for these chunks the server has no file, so
 * that their voxels have the fill value. Returns 0 for all other volumes. *chunks receives the number of
 * chunks of the whole volume; chunks may be null. */
HL_API size_t hl_volume_absent_chunks(const hl_volume *volume, size_t *chunks);

/* An array of the file that a volume was loaded from. */
typedef struct hl_volume_array {
  size_t struct_size; /* set by the caller */
  const char *name;   /* the array's name, which belongs to the volume; "" if the format has no names */
  size_t components;  /* number of values of each voxel, or number of volumes of a series */
  hl_voxel_type type; /* the type of the values; if 0, this type cannot be read */
  int of_cells;       /* non-zero if VTK's values belong to cells, which lie between the points */
  int chosen;         /* non-zero if the volume was read from this array */
  int component;      /* only for the array that was read: the number of the component that was read, or an
                       * HL_COMPONENT_ value. HL_COMPONENT_LUMINANCE stands for colours whose luminance gives
                       * the opacity */
} hl_volume_array;

/* Returns the number of arrays in the volume's file; arrays beyond 256 are not counted. Returns 0 if the
 * volume came from memory or shapes. */
HL_API size_t hl_volume_array_count(const hl_volume *volume);
HL_API HL_WARN_UNUSED hl_status hl_volume_get_array(const hl_volume *volume, size_t index,
                                                    hl_volume_array *array);

/* Finds percentiles of the finite voxels' data values: each of `percents` is from 0 to 100. The percentiles
 * are exact: a percentile between two successive values is interpolated, as by numpy.percentile(). If no
 * voxel is finite, all percentiles are 0. values: [count]. The function reads all voxels. */
HL_API HL_WARN_UNUSED hl_status hl_volume_percentiles(const hl_volume *volume, const double *percents,
                                                      size_t count, double *values, hl_error *error);

/* The numbers of time steps, channels and resolutions of the volume's file, each at least 1, and the indices
 * of the ones that were read. */
typedef struct hl_volume_selection {
  size_t struct_size; /* set by the caller */
  size_t times, channels, levels;
  int time, channel, level;
  int aim; /* the resolution that the options for reading ask for. It differs from `level` if a coarser one
            * was read for a first picture (hl_volume_load_options.preview_pixels) */
  int level_is_named; /* non-zero if the caller has named the resolution (hl_volume_load_options.level) */
  int is_part;        /* non-zero if voxels out of sight were interpolated (hl_volume_load_options.seen) */
} hl_volume_selection;

HL_API HL_WARN_UNUSED hl_status hl_volume_get_selection(const hl_volume *volume,
                                                        hl_volume_selection *selection);

/* A channel of a file with several channels, as the file describes it. */
typedef struct hl_volume_channel {
  size_t struct_size; /* set by the caller */
  const char *name;   /* the channel's name, which belongs to the volume; "" if the file has none */
  int has_color;
  double srgb[3];   /* the channel's sRGB colour, 0 to 1; all 0 if the file has none */
  double window[2]; /* the range of data values that the file recommends for showing the channel; NaN: the
                     * file recommends none */
  int chosen;       /* non-zero if the volume was read from this channel */
} hl_volume_channel;

/* Describes a channel of the volume's file. index: from 0 to the number of channels - 1
 * (hl_volume_get_selection()). If the file does not describe its channels, they have neither names nor
 * colours nor windows. */
HL_API HL_WARN_UNUSED hl_status hl_volume_get_channel(const hl_volume *volume, size_t index,
                                                      hl_volume_channel *channel);

/* One of the series of DICOM slices in a folder or an archive. */
typedef struct hl_volume_series {
  size_t struct_size;                       /* set by the caller */
  const char *uid, *modality, *description; /* texts of the series' files, which belong to the volume; "" if
                                             * the files lack them */
  double number;                            /* NaN: none */
  size_t dimensions[3];                     /* the numbers of columns and rows, and the number of the slices
                                             * of all time steps */
  int chosen;                               /* non-zero if the volume was read from this series */
} hl_volume_series;

/* Returns the number of series in the input that the volume came from. Returns 0 if the volume came from
 * other files or from memory. */
HL_API size_t hl_volume_series_count(const hl_volume *volume);
HL_API HL_WARN_UNUSED hl_status hl_volume_get_series(const hl_volume *volume, size_t index,
                                                     hl_volume_series *series);

/* A segment of a label map, as the label map's file describes it. */
typedef struct hl_volume_segment {
  size_t struct_size; /* set by the caller */
  const char *name;   /* the segment's name, which belongs to the volume; "" if the file has none */
  int64_t value;      /* the value of the segment's voxels */
  int layer;          /* the number, from 0, of the component in which the segment's voxels have the value */
  int has_color;
  double srgb[3]; /* the segment's sRGB colour, 0 to 1; all 0 if the file has none */
} hl_volume_segment;

/* Returns the number of segments that the volume's file names; 0 if it names none. */
HL_API size_t hl_volume_segment_count(const hl_volume *volume);
HL_API HL_WARN_UNUSED hl_status hl_volume_get_segment(const hl_volume *volume, size_t index,
                                                      hl_volume_segment *segment);

/* Returns the path, within the volume's file, of label map number `index`, as "labels/cells". Such label maps
 * lie beside the volume in the file (the "labels" of OME-Zarr), and are opened as volumes of their own. The
 * text belongs to the volume. Returns null past the last label map. */
HL_API const char *hl_volume_label_map(const hl_volume *volume, size_t index);

enum { HL_NUMBER_TEXT_BYTES = 64 };

/* Writes the least (end 0) or the greatest (end 1) finite data value as text: as a decimal number that reads
 * back as the same number. Whole numbers have all of their digits; this includes numbers of 64 bits that a
 * double would round. text: has room for HL_NUMBER_TEXT_BYTES bytes. */
HL_API HL_WARN_UNUSED hl_status hl_volume_write_range(const hl_volume *volume, int end, char *text);

/* Returns the data value of voxel (i, j, k); NaN if the value is not finite, or if the voxel is outside the
 * grid. */
HL_API double hl_volume_value(const hl_volume *volume, size_t i, size_t j, size_t k);

/* Returns the name of a voxel type, as "uint8", "int16" or "float32". */
HL_API const char *hl_voxel_type_name(hl_voxel_type type);

#ifdef __cplusplus
}
#endif
#endif
