/* cli/host.h - the library's context as the program sets it up: memory limit, warnings, progress bar,
 * interruption by signals. */
#ifndef HL_CLI_HOST_H
#define HL_CLI_HOST_H

#include <stdbool.h>

#include "message.h"
#include "output.h"

/* The stage in which a call of the library is, as it reports its progress. */
typedef struct host_stage {
  char name[16];
  double began;     /* seconds of clock_seconds() */
  double fraction;  /* the part that was done at the last report */
  const char *hint; /* what makes the command faster; said once where it takes long; null: nothing is said */
} host_stage;

typedef struct cli_host {
  hl_context *context;
  bool quiet;   /* the program prints no warnings, no bar and no summary */
  bool bar;     /* stderr is a terminal that can redraw a line */
  bool own_bar; /* the command draws the progress bar itself, because each call of the library is only a part
                 * of the command's work */
  bool color;
  bool drawn; /* a bar is on the line now */
  host_stage stage;
  double drawn_at;         /* seconds; bars are redrawn ten times a second at most */
  bool (*cancelled)(void); /* or null */
  void (*progressed)(const char *stage, double fraction); /* or null */
  uint64_t memory_limit;                                  /* bytes; 0: unknown */
  int preview_pixels;    /* hl_volume_load_options.preview_pixels for the volumes of the command line */
  cli_read_files read;   /* the files that the context has read */
  char *const *operands; /* see cli_host_options */
  char subject[32];      /* the input's name beside the bar, cut to keep the line short */
} cli_host;

typedef struct cli_host_options {
  bool quiet;
  bool progress;
  const char *subject;
  uint64_t memory_limit; /* bytes; 0: the machine's memory */
  hl_instruction_set instruction_set;
  const char *device;      /* null: the processors */
  bool keep_unsmoothed;    /* see hl_context_options */
  hl_mpi mpi;              /* launcher_mpi() (ranks.h) where processes may join */
  bool (*cancelled)(void); /* asked, in addition to signals, whether the run is to end; called by the thread
                            * that renders; may be null */
  void (*progressed)(const char *stage, double fraction); /* receives the progress of a library call, on the
                                                           * thread that made the call; may be null */
  const char *data_folder;                                /* null: HALFLIGHT_DATA, or ../shared/data */
  char *const *operands; /* the command line's INPUTs, ended by null; the array must outlive the context.
                          * Files are fetched only from INPUTs that are URLs. May be null */
} cli_host_options;

/* Rows for the table of options of a subcommand: the options of the context. heading: the heading of the
 * group that begins with the row, or null. */
#define HOST_OPTION_DATA(heading)                                                                           \
  {                                                                                                         \
    .name = "data", .kind = OPTION_TEXT, .argument = "FOLDER", .group = (heading),                          \
    .help = "where the files are that scenes call data:NAME\n(default: $HALFLIGHT_DATA, or ../shared/data)" \
  }
#define HOST_OPTION_THREADS(heading)                                                        \
  {                                                                                         \
    .name = "threads", .kind = OPTION_NUMBERS, .argument = "N", .group = (heading),         \
    .help = "number of threads; 0: one per processor (default)", .count = 1, .whole = true, \
    .setting_kind = HL_SETTINGS_RENDER, .setting = "threads"                                \
  }
#define HOST_OPTION_MAX_MEMORY(heading)                                                        \
  {                                                                                            \
    .name = "max-memory", .kind = OPTION_BYTES, .argument = "BYTES", .group = (heading),       \
    .help = "fail rather than hold more; suffix K, M, G or T\n(default: the machine's memory)" \
  }
#define HOST_OPTION_DEVICE                                                               \
  {                                                                                      \
    .name = "device", .kind = OPTION_TEXT, .argument = "NAME",                           \
    .help =                                                                              \
        "cpu (default), gpu, auto: a GPU where it is\nfaster, or a part of a name that " \
        "'halflight\ndevices' lists; any gives the same picture"                         \
  }
#define HOST_OPTION_QUIET \
  { .name = "quiet", .kind = OPTION_SWITCH, .help = "no progress bar, no warnings, no summary" }

/* Makes the context and starts listening to SIGINT, SIGTERM and SIGHUP. Returns the exit code. `host` must
 * not move until host_close(). */
int host_open(const cli_host_options *options, cli_host *host);
void host_close(cli_host *host);

/* Writes a time: "3 h 20 min", "4 min 1 s", "12 s". */
void host_describe_time(double seconds, char *text, size_t size);

/* Draws a bar with a text beside it, ten times a second at most, where there is a terminal. */
void host_draw_bar(cli_host *host, double fraction, const char *text);

/* Removes the progress bar, so that a line can be printed. */
void host_clear_bar(cli_host *host);

/* Prints the line of a library error after clearing the bar; returns the exit code. */
int host_fail(cli_host *host, cli_phase phase, hl_status status, const hl_error *error);

/* True once the user has asked to stop. */
bool host_interrupted(void);

/* Seconds of a steady clock. */
double clock_seconds(void);

#endif
