/* volume/formats/format.h - declares the interface between hl_volume_load and the readers of file formats,
 * and the functions that readers share.
 *
 * The reader of a format is one file NAME.c, which defines `const hl_format hl_format_NAME`. formats.h is the
 * registry of these NAMEs. A reader lists the file's arrays in its request, asks for a choice, and reads the
 * chosen array. If the caller names no array or no component, a warning says which array or component is
 * read. */
#ifndef HL_VOLUME_FORMAT_H
#define HL_VOLUME_FORMAT_H

#include "volume/io/bundle.h"
#include "volume/io/payload.h"

enum { HL_ARRAYS_MOST = 256 }; /* greatest number of arrays that are listed for one file */

/* A request to load a volume from a file. A request holds the choices of the caller, and the facts that the
 * reader finds in the file. */
typedef struct hl_load_request {
  hl_context *context;
  const char *array;          /* null if the reader may choose */
  int component;              /* HL_COMPONENT_DEFAULT, HL_COMPONENT_MAGNITUDE, or an index */
  double spacing[3];          /* world units; all 0 if the file's own spacing is used */
  int time, channel, level;   /* HL_INDEX_DEFAULT, or an index */
  const char *channel_name;   /* the name or the number of the wanted channel, as text; null after the channel
                               * was found in the file, and if the caller names no channel */
  int pixels;                 /* pixels of the picture's longer side; 0 if unknown */
  int preview_pixels;         /* pixels of the longer side of a first picture; 0 if the caller wants no first
                               * picture */
  const hl_volume *coarse;    /* the coarser volume in hl_volume_load_options; null if all voxels are read */
  const double (*seen)[4][4]; /* [seen_count]; the planes in hl_volume_load_options */
  size_t seen_count;
  double window[2];       /* set by readers: the data values that are shown black and white; both equal if
                           * the file does not state them */
  hl_channel *channels;   /* owned; [selection.channels]; set by readers if the file describes channels */
  const char *unit;       /* set by readers: the unit of lengths, static; null if the file does not state
                           * it */
  hl_absence absence;     /* set by readers of stores on servers */
  bool is_anatomical;     /* set by readers of medical formats: whether the file states its anatomical space
                           * explicitly */
  bool says_labels;       /* set by readers: whether the file says that its values are labels */
  bool says_fog;          /* set by readers: whether the file says that its values are the density of a fog */
  const char *series;     /* DICOM: the number, UID or description of the wanted series; null if the
                           * reader may choose */
  hl_array_entry *arrays; /* owned; [array_count]; the arrays, in the file's order */
  size_t array_count;
  size_t chosen; /* index of the array that is read */
  int chosen_component;
  hl_series_entry *series_list; /* owned; [series_count]; DICOM series */
  size_t series_count, chosen_series;
  bool more;                  /* whether the file has more than HL_ARRAYS_MOST arrays */
  hl_selection selection;     /* the numbers of times, channels and levels in the file, which are 1 until the
                               * reader sets the numbers; also the time, channel and level to read */
  hl_resolutions resolutions; /* set by hl_level_choose() */
  char array_told[1000], component_told[400],
      selection_told[600]; /* warnings that name the array, the component, and the time and channel that were
                            * chosen by default; "" if nothing was chosen by default */
} hl_load_request;

/* Adds an array to the list. name: "" if arrays have no names in the format; type: 0 if arrays of the array's
 * type cannot be read. */
hl_status hl_arrays_add(hl_load_request *request, const char *name, size_t components, hl_voxel_type type,
                        bool of_cells, hl_error *error);

/* Sets request->chosen to the array that the caller has named. If the caller has named no array, the choice
 * is the array `active` (-1: the file has no active array), else the first array of one component at points,
 * else the first array of one component at cells, else the first array. Arrays that number the points or the
 * cells are chosen only if the file has no other arrays. The list must not be empty. */
hl_status hl_arrays_choose(hl_load_request *request, const char *path, int active, hl_error *error);

/* Chooses the component to read, and stores its index in the payload, whose `components` and `block` must be
 * set. The choice is the wanted component. If the caller wants none, the choice is the only component, or the
 * magnitude of vectors of two or three components, or the first component. is_series: whether components are
 * time steps and channels. In a series of time steps and channels, the time steps of a channel are adjacent
 * components. request->selection has the numbers of times and channels; if request->selection has no such
 * numbers, all components are times. By default the first time step of the first channel is read. Refuses a
 * time, a channel or a level that request->selection does not have. */
hl_status hl_component_choose(hl_load_request *request, const char *path, bool is_series, hl_payload *payload,
                              hl_error *error);

/* Chooses a time step and a channel, and sets the members of request->selection that concern times and
 * channels. Refuses a time or a channel that the file does not have. */
hl_status hl_steps_choose(hl_load_request *request, const char *path, size_t times, size_t channels,
                          hl_error *error);

/* Allocates request->channels, with empty descriptions. The number of channels must be known. */
hl_status hl_channels_make(hl_load_request *request, hl_error *error);

/* Selects the channel that the caller has named. Readers call hl_channel_find() when request->channels has
 * the names, and before reading voxels. The error for an unknown name lists the names of the channels. */
hl_status hl_channel_find(hl_load_request *request, const char *path, hl_error *error);

/* Fails if the caller has named a channel, but the reader has not found the channel in the file. */
hl_status hl_channel_check(hl_load_request *request, const char *path, hl_error *error);

/* Sets the name of a channel. A long name is cut, and unprintable characters become '?'. */
void hl_channel_name(hl_channel *channel, const char *name);

/* The size in voxels of one level of a pyramid of resolutions. */
typedef struct hl_level_size {
  size_t dimensions[3];
  hl_voxel_type type;
} hl_level_size;

/* Sets request->selection's level among `count` levels, of which the finest is first. The choice is the
 * wanted level. If the caller wants none, the choice is the finest level that leaves half of the memory limit
 * free and has at most 2^30 voxels, or a coarser level that still has a voxel for each of the request's
 * pixels. The chosen level becomes the selection's aim. For a first picture, the selection's level is the
 * coarsest level that has a voxel for each of its preview_pixels pixels. */
hl_status hl_level_choose(hl_load_request *request, const char *path, const hl_level_size *levels,
                          size_t count, hl_error *error);

/* Lists the array of a file that has a single array without a name, and chooses the component. */
hl_status hl_component_only(hl_load_request *request, const char *path, bool is_series, hl_payload *payload,
                            hl_error *error);

enum { HL_FORMAT_SNIFFED_BYTES = 1024, HL_FORMAT_ENDINGS = 3 };

/* A format's reader. Every member of hl_format except `load` may be null. */
typedef struct hl_format {
  const char *name;                       /* name of the format in error lines */
  const char *endings[HL_FORMAT_ENDINGS]; /* extensions of the names of files that must start with
                                           * `beginning`; null follows the last extension */
  const char *title;                      /* name of the format in lists of formats; if null, lists show
                                           * `name` */
  const char *more_endings;     /* other extensions of files of this format, separated by blanks; used only in
                                 * lists of formats */
  const char *(*missing)(void); /* returns the name of the library that the format needs, if this build lacks
                                 * it; else null */
  const char *beginning;        /* the bytes with which a file of this format must begin, as error lines
                                 * describe them */

  /* Returns whether a file that begins with these bytes has the format. length: HL_FORMAT_SNIFFED_BYTES, or
   * less if the file is shorter. */
  bool (*has_content)(const unsigned char *bytes, size_t length);

  /* Returns whether the file's name alone proves the format, independently of the file's bytes. The fits() of
   * all formats are called before any has_content(). */
  bool (*fits)(const hl_stream *stream);

  /* Sets *claimed to whether the file's name suggests the format. The function is called only if
   * has_content() of all formats is false. May replace *stream by the file that holds the header. */
  hl_status (*claim_name)(hl_stream **stream, bool *claimed, hl_error *error);

  /* Reads *stream from its current position. The function may replace *stream, or push decoders on *stream.
   * The caller closes it. */
  hl_status (*load)(hl_stream **stream, hl_load_request *request, hl_volume **volume, hl_error *error);

  /* Reads a folder or a zip archive. *claimed: set to false if the folder or archive contains nothing of the
   * format. If *claimed is false, load_bundle() of the next format is called. */
  hl_status (*load_bundle)(hl_bundle *bundle, hl_load_request *request, bool *claimed, hl_volume **volume,
                           hl_error *error);

  /* finds_by_name: whether load_bundle() opens files by their names, without a list of all files. Only
   * formats that open files by their names can be read from servers. */
  bool finds_by_name;
} hl_format;

/* All formats, in the order in which their functions are called for a file (formats.h); null after the last
 * format. */
extern const hl_format *const hl_formats[];

/* The name that a format gives to a voxel type. name may list alternatives, as in hl_text_is_one_of(). */
typedef struct hl_named_type {
  const char *name;
  hl_voxel_type type;
} hl_named_type;

/* Finds the voxel type with this name. Returns false if no type has the name. */
bool hl_find_type(const hl_named_type *types, size_t count, const char *name, hl_voxel_type *type);

/* For text headers: fails with "PATH, line N: ...". */
#define HL_FAIL_LINE(error, code, stream, line, format, ...) \
  hl_fail_at(error, code, line, 0, "%s, line %d: " format, (stream)->path, line, __VA_ARGS__)

#endif
