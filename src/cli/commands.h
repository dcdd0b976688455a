/* cli/commands.h - registers the subcommands. */
#ifndef HL_CLI_COMMANDS_H
#define HL_CLI_COMMANDS_H

#include "options.h"

extern const cli_command render_command;  /* render.c */
extern const cli_command info_command;    /* info.c */
extern const cli_command convert_command; /* convert.c */
extern const cli_command diff_command;    /* diff.c */
extern const cli_command bench_command;   /* bench.c */
extern const cli_command make_command;    /* make.c */
extern const cli_command view_command;    /* view.c */
extern const cli_command animate_command; /* animate.c */
extern const cli_command looks_command;   /* looks.c */
extern const cli_command export_command;  /* export.c */
extern const cli_command figure_command;  /* figure.c */
extern const cli_command figures_command; /* figures.c */
extern const cli_command devices_command; /* devices.c */

#endif
