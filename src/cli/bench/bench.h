/* cli/bench/bench.h - declares the functions that the files of `halflight bench` share. */
#ifndef HL_CLI_BENCH_BENCH_H
#define HL_CLI_BENCH_BENCH_H

#include "cli/host.h"
#include "cli/options.h"

enum bench_option {
  BENCH_FRAMES,
  BENCH_ONLY,
  BENCH_MOVE,
  BENCH_SIZE,
  BENCH_TF,
  BENCH_SHEET_SPACING,
  BENCH_KERNEL,
  BENCH_RECONSTRUCTION,
  BENCH_THREADS,
  BENCH_INSTRUCTION_SET,
  BENCH_DEVICE,
  BENCH_MAX_MEMORY,
  BENCH_JSON,
  BENCH_OPTION_COUNT
};

/* The kinds of shadows that are compared. */
enum bench_setting {
  SETTING_OFF,
  SETTING_HARD,
  SETTING_PAPER,
  SETTING_CASCADE,
  SETTING_SUBLIGHTS,
  SETTING_COUNT
};
extern const cli_choice bench_settings[SETTING_COUNT + 1]; /* their names, in that order */

/* The kinds of motion: the part of the scene that changes from frame to frame. */
enum bench_move { MOVE_CAMERA, MOVE_LIGHT, MOVE_TF };

/* The stages of one frame whose times are measured, in the order of the report. */
enum bench_stage {
  STAGE_PREPARE,
  STAGE_SORT,
  STAGE_SPLAT_EYE,
  STAGE_SPLAT_LIGHT,
  STAGE_SHADE,
  STAGE_COMPOSITE_LIGHT,
  STAGE_SOFTEN,
  STAGE_DEVICE,
  STAGE_OTHER,
  STAGE_COUNT
};

typedef struct bench_sample {
  double frame, processor, stage[STAGE_COUNT]; /* times in seconds; `processor` is the processor time of all
                                                * threads together */
} bench_sample;

typedef struct bench_run {
  bool supported;
  bench_sample first;              /* the first frame of the warm-up, which includes preparing the volumes */
  bench_sample *samples;           /* owned; [frames] */
  hl_render_statistics statistics; /* of the last frame */
} bench_run;

typedef struct bench_result {
  const char *input;
  int width, height, frames, move;
  bench_run run[SETTING_COUNT];
} bench_result;

/* Makes the scene with the shadows of one setting at one moment of the motion. at: the moment, from 0 (the
 * motion's start) to 1 (its end). After an error, which is printed, the result is null and *exit_code is set.
 */
hl_scene *bench_scene_at(cli_host *host, const hl_scene *scene, enum bench_setting setting,
                         enum bench_move move, double at, int *exit_code);

/* Makes a scene without files: balls along a knotted line. */
hl_status bench_scene_built_in(hl_context *context, hl_scene **scene, hl_error *error);

#endif
