/* halflight/context.h - makes the context: memory, messages, progress and cancellation.
 *
 * Pointers may be null only where a function says so; otherwise null is refused with HL_ERROR_ARGUMENT.
 * Functions without a status as result do nothing for such a null, or return null, 0 or NaN. No null crashes
 * the program.
 *
 * Every other object of the library is made with a context, and must be released before the context is
 * destroyed. The library keeps no global state, prints nothing, never exits and reads no environment
 * variables. */
#ifndef HALFLIGHT_CONTEXT_H
#define HALFLIGHT_CONTEXT_H

#include <stddef.h>
#include <stdint.h>

#if defined(__GNUC__) || defined(__clang__)
#define HL_API         __attribute__((visibility("default")))
#define HL_WARN_UNUSED __attribute__((warn_unused_result))
#else
#define HL_API
#define HL_WARN_UNUSED
#endif

#ifdef __cplusplus
extern "C" {
#endif

#define HL_VERSION_MAJOR 0
#define HL_VERSION_MINOR 1
#define HL_VERSION_PATCH 0

/* The result of a call. Every other value than HL_OK means that the call failed. */
typedef enum hl_status {
  HL_OK = 0,
  HL_ERROR_ARGUMENT = 1, /* an argument of the call is impossible: null, out of range, or of a wrong
                          * struct_size */
  HL_ERROR_MEMORY = 2,   /* the allocator returned null, or the context's memory limit was reached */
  HL_ERROR_IO = 3,       /* a file could not be opened, read, written or renamed */
  HL_ERROR_INPUT = 4,    /* a file or a scene is malformed */
  /* the input is well-formed, but this version has no support for a feature that the input needs */
  HL_ERROR_UNSUPPORTED = 5,
  HL_ERROR_CANCELLED = 6, /* the context's callback `cancelled` stopped the call */
  HL_ERROR_INTERNAL = 7   /* the library itself has a fault */
} hl_status;

/* An error, which says why a call failed. Every failing call fills the hl_error that it is given; null is
 * always allowed. `message` is one line that names the file or key and the place in it, and says what is
 * wrong and how to mend it. line and column count from 1; they are 0 where the error is not in a text.
 * byte_offset is the place of the error in a file; -1 if unknown. */
typedef struct hl_error {
  hl_status code;
  int line;
  int column;
  int64_t byte_offset;
  char message[1000];
} hl_error;

typedef enum hl_log_level { HL_LOG_WARNING = 1, HL_LOG_INFO = 2 } hl_log_level;

/* The processor's sets of instructions for which the library's slowest functions are compiled. The results
 * have the same bytes with every set. */
typedef enum hl_instruction_set {
  HL_INSTRUCTION_SET_AUTO = 0,       /* the best set that the processor has */
  HL_INSTRUCTION_SET_SCALAR = 1,     /* the instructions that every processor of the compiler's target has; on
                                      * 64-bit Arm they are used without vectors */
  HL_INSTRUCTION_SET_AVX2 = 2,       /* AVX2 and FMA: Haswell, Zen and later */
  HL_INSTRUCTION_SET_AVX512 = 3,     /* AVX-512 F, DQ, BW and VL: Skylake servers and later */
  HL_INSTRUCTION_SET_NEON = 4,       /* every 64-bit Arm processor */
  HL_INSTRUCTION_SET_AVX512_VBMI = 5 /* AVX-512 with VBMI, VBMI2 and VNNI: Ice Lake, Zen 4 and later */
} hl_instruction_set;

/* The MPI libraries by which processes of a job can join (halflight/ranks.h). The library for Open MPI 4 or 5
 * is libmpi.so.40. The library for MPICH 3.1 or later, or for another MPI with the same binary interface, is
 * libmpi.so.12 or libmpich.so.12. */
typedef enum hl_mpi {
  HL_MPI_AUTO = 0, /* the library that the process has loaded; if it has loaded none: Open MPI, or MPICH if
                    * Open MPI is missing */
  HL_MPI_OPEN_MPI = 1,
  HL_MPI_MPICH = 2
} hl_mpi;

/* The bytes of a file on a server that a caller wants. */
typedef struct hl_fetch_range {
  uint64_t begin; /* the position of the first wanted byte in the file; UINT64_MAX: the last `count` bytes are
                   * wanted, or all bytes if the file is shorter */
  uint64_t count; /* the number of wanted bytes; if 0, the whole file is wanted */
} hl_fetch_range;

/* Bytes of a file on a server, as the callback `fetch` brings them. */
typedef struct hl_fetched_file {
  int descriptor; /* a file, open for reading, whose first `size` bytes are the brought bytes; its current
                   * position does not matter; -1: the server has no such file */
  uint64_t size;  /* the number of the brought bytes; further bytes of the descriptor's file are not read */
  uint64_t begin; /* the position of the first of the brought bytes in the server's file */
  uint64_t whole; /* the size of the whole file on the server, in bytes */
  uint64_t state; /* a number that stands for the version of the server's file: different versions have
                   * different numbers; if 0, the server names no version */
} hl_fetched_file;

/* Callbacks and limits of a context. All callbacks may be null, in which case a default is used, and receive
 * user_data. The library calls `allocate` and `release` from any of its threads, and all other callbacks only
 * from the thread that called the library. Callbacks may call the library, but not with the renderer whose
 * frame is being made. Callbacks run in C's default floating-point environment, whatever environment the host
 * has set. */
typedef struct hl_context_options {
  size_t struct_size; /* set by hl_context_options_defaults() */
  void *user_data;
  /* Returns size bytes aligned to alignment (a power of two, at least 64), or null. */
  void *(*allocate)(void *user_data, size_t size, size_t alignment);
  void (*release)(void *user_data, void *memory);
  void (*log)(void *user_data, hl_log_level level, const char *message);
  /* Tells how far the named stage is: the fraction is from 0 to 1. The stages are "load", "prepare" (labels
   * are smoothed), "sky" (the field of the sky's light is made), "render" and "write". A frame has several
   * stages, each of which begins at 0. */
  void (*progress)(void *user_data, const char *stage, double fraction);
  /* Called every few milliseconds while a call runs. A non-zero result makes the running call return
   * HL_ERROR_CANCELLED soon: within a tenth of a second, for pictures up to 4096 x 4096 pixels and volumes up
   * to 512^3 voxels. */
  int (*cancelled)(void *user_data);
  uint64_t memory_limit;              /* the greatest number of bytes that the context may hold at once; 0 if
                                       * there is no limit */
  hl_instruction_set instruction_set; /* the instructions that the library uses; hl_context_create() refuses a
                                       * set that the processor lacks */
  const char *data_folder; /* the folder in which a scene's file names of the form "data:..." begin; copied;
                            * null if there is no such folder */
  /* Called with the path of every file that is opened for reading: scenes, volumes, the data files that their
   * headers name, transfer functions, pictures. A program can remember the paths, so that it does not write
   * over one of these files. */
  void (*reads)(void *user_data, const char *path);
  /* Called for a file of a format that another program must convert first, as "OpenVDB". The callback runs
   * this program, and gives the bytes of the file that the program makes, as NanoVDB. The library reads these
   * bytes in place of the file. If there is no such program, the callback fails with HL_ERROR_UNSUPPORTED.
   * The library runs no program itself. */
  hl_status (*convert)(void *user_data, const char *format, const char *path, const void **bytes,
                       size_t *byte_count, hl_error *error);
  /* Releases the bytes that `convert` gave. */
  void (*converted)(void *user_data, const void *bytes, size_t byte_count);
  /* Called where a volume's file is the URL of a Zarr store on a server ("http://..." or "https://..."). The
   * callback brings bytes of `count` files of the store, whose names are relative to the store ("0/c/1/2/3").
   * ranges: [count], the bytes that are wanted; if null, whole files are wanted. If the server sends no
   * ranges, the callback brings the whole file. The callback brings at most `most` bytes of each file. files:
   * [count], whose descriptors the library closes, also after a failure. The store may lack some files: for
   * these, the callback sets the descriptor to -1. Every other fault must be an error; so must bytes that are
   * not the wanted ones. The callback decides which URLs may be asked, because a scene's text can name any
   * URL. Null (default): URLs are refused. The library itself uses no network. */
  hl_status (*fetch)(void *user_data, const char *url, const char *const *names, const hl_fetch_range *ranges,
                     size_t count, uint64_t most, hl_fetched_file *files, hl_error *error);
  /* A folder on a disk for scratch files; copied; null (default): there is none. A volume of one component
   * may be too large for memory_limit, together with the tables that a renderer makes of its voxels. The
   * voxels of such a volume are then written to a scratch file, and the volume is rendered from this file.
   * The scratch file has no name, and is 1.15 times as large as the voxels. Parts of it are kept in memory as
   * far as the limit leaves room; at least 16 times 64^3 voxels are kept. */
  const char *scratch_folder;
  /* The device that makes the renderers' frames. "cpu" (the default, also null): the processors. "gpu": the
   * first GPU. "auto": the first GPU, if the first frame shows that it is faster than the processors. "cuda"
   * or "opencl": the first device of that interface. Any other text: the first device whose name contains the
   * text, such as "H100". The text is copied. The processors make a frame if there is no such device, or if
   * the device cannot make the frame. The picture's bytes are then the same, and hl_render_statistics tells
   * the reason. Drivers are loaded only when a device is to make the first frame. */
  const char *device;
  const char *cache_folder; /* A folder for kernels that were compiled for devices. It holds at most 64 MiB,
                             * and only the user can read it. The library makes the folder if its parent
                             * folder exists. Copied; null (default): kernels are not kept, and each context
                             * compiles them anew */
  hl_mpi mpi; /* the MPI library that hl_ranks_join() loads: it must be the one that belongs to the program
               * that started the processes */
  /* Non-zero: a smoothed volume keeps the voxels of which it was made, for hl_volume_unsmoothed(). The
   * library moves voxels that it owns to a scratch file in scratch_folder. Without this folder, and where the
   * caller has lent the voxels, they stay in memory. 0 (default): a smoothed volume does not keep these
   * voxels. */
  int keep_unsmoothed;
} hl_context_options;

typedef struct hl_context hl_context; /* A context: the memory, the callbacks and the limits that calls share.
                                       * Several threads may use a context at once */

HL_API void hl_context_options_defaults(hl_context_options *options);

/* Makes a context. options may be null for the defaults. *context is owned by the caller, who destroys it
 * with hl_context_destroy(). */
HL_API HL_WARN_UNUSED hl_status hl_context_create(const hl_context_options *options, hl_context **context,
                                                  hl_error *error);

/* Changes the context's `memory_limit` and `scratch_folder`. Volumes that were loaded before stay in memory
 * or in their scratch file. scratch_folder: copied; null if there is none. Call this function only while no
 * other call with the context runs. */
HL_API HL_WARN_UNUSED hl_status hl_context_limit_memory(hl_context *context, uint64_t memory_limit,
                                                        const char *scratch_folder, hl_error *error);

/* Makes a confined context, for files that strangers wrote. A confined context opens only regular files below
 * `folder`. All names of files are relative to `folder`; this also holds for the names that are stored in
 * files. Absolute names, URLs, "data:..." and names that lead out of the folder by ".." or by a link are
 * refused, with the same message as for files that do not exist. folder: a path, relative to the folder of
 * `context` if that context is confined; if null, every file is refused. Only reading is confined: files are
 * written where the caller says. The confined context shares the memory, the memory limit and the callbacks
 * of `context`, but does not call `reads`. *confined is owned by the caller. The caller may destroy it before
 * the objects that were made with it; `context` must outlive these objects. */
HL_API HL_WARN_UNUSED hl_status hl_context_confine(hl_context *context, const char *folder,
                                                   hl_context **confined, hl_error *error);

/* Destroys a context. Null is allowed. Everything made with the context must be released before; a confined
 * context may be destroyed earlier (hl_context_confine()). */
HL_API void hl_context_destroy(hl_context *context);

/* Return the number of bytes that the context holds now, and the greatest number that it has held at once. */
HL_API uint64_t hl_context_memory_held(const hl_context *context);
HL_API uint64_t hl_context_memory_peak(const hl_context *context);

HL_API hl_instruction_set hl_context_instruction_set(const hl_context *context);
HL_API const char *hl_instruction_set_name(hl_instruction_set set);

/* Returns the name of a status, as "ok" or "malformed input"; never null. */
HL_API const char *hl_status_name(hl_status status);

/* "0.1.0" */
HL_API const char *hl_version(void);

#ifdef __cplusplus
}
#endif
#endif
