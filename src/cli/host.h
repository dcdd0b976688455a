/* cli/host.h - makes the library's context for the program: memory limit, warnings, progress bar,
 * interruption by signals. */
#ifndef HL_CLI_HOST_H
#define HL_CLI_HOST_H

#include <stdbool.h>

#include "message.h"
#include "output.h"
#include "platform/clock.h"

/* The current stage of a call of the library, which reports its progress. */
typedef struct host_stage {
  char name[16];
  double began;     /* seconds of hl_clock_seconds() */
  double fraction;  /* the fraction of the stage that was done at the last report */
  const char *hint; /* advice on how to make the command faster, which is printed once if the command takes
                     * long; null if there is no advice */
} host_stage;

typedef struct cli_host {
  hl_context *context;
  bool quiet;      /* whether the program prints no warnings, no bar and no summary */
  char said[1000]; /* the last message; a message that is the same again is not repeated */
  bool bar;        /* whether stderr is a terminal that can redraw a line */
  bool own_bar; /* whether the command draws the progress bar itself, because each call of the library is only
                 * a part of the command's work */
  bool color;
  bool drawn; /* whether a bar is on the current line */
  host_stage stage;
  double drawn_at;         /* the time, in seconds, at which the bar was last drawn; bars are redrawn ten
                            * times a second at most */
  bool (*cancelled)(void); /* or null */
  void (*progressed)(const char *stage, double fraction); /* or null */
  void (*warned)(const char *message);                    /* or null */
  uint64_t memory_limit;                                  /* bytes; 0 if it is unknown */
  int preview_pixels;    /* the value of hl_volume_load_options.preview_pixels for the volumes of the command
                          * line */
  cli_read_files read;   /* the files that the context has read */
  char *const *operands; /* see cli_host_options */
  char subject[32];      /* the input's name beside the bar, cut to keep the line short */
} cli_host;

typedef struct cli_host_options {
  bool quiet;
  bool progress;
  const char *subject;
  uint64_t memory_limit; /* bytes; 0 stands for the machine's memory */
  hl_instruction_set instruction_set;
  const char *device;      /* null stands for the processors */
  bool keep_unsmoothed;    /* see hl_context_options */
  hl_mpi mpi;              /* the result of launcher_mpi() (ranks.h) if processes may join */
  bool (*cancelled)(void); /* a function that is asked, in addition to signals, whether the run should end;
                            * the thread that renders calls it; may be null */
  void (*progressed)(const char *stage, double fraction); /* receives the progress of a library call, on the
                                                           * thread that made the call; may be null */
  void (*warned)(const char *message);                    /* receives the library's warnings, also if `quiet`
                                                           * keeps them from being printed; may be null */
  const char *data_folder;                                /* the folder of "data:..." files; null stands for
                                                           * HALFLIGHT_DATA, or ../shared/data */
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

/* Draws a bar with a text beside it, ten times a second at most, if there is a terminal. */
void host_draw_bar(cli_host *host, double fraction, const char *text);

/* Removes the progress bar, so that a line can be printed. */
void host_clear_bar(cli_host *host);

/* Prints the line of a library error after clearing the bar; returns the exit code. */
int host_fail(cli_host *host, cli_phase phase, hl_status status, const hl_error *error);

/* Returns whether the user has asked to stop. */
bool host_interrupted(void);

#endif
