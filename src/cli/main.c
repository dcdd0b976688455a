/* cli/main.c - starts the program: finds the subcommand, and answers --help and --version. */
#define _GNU_SOURCE
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "commands.h"
#include "message.h"
#include "platform/program.h"
#include "ranks.h"
#include "suggest.h"
#include "text/edit_distance.h"

static const cli_command *const commands[] = {
    &render_command,  &info_command,   &make_command,    &convert_command, &diff_command,
    &bench_command,   &view_command,   &animate_command, &looks_command,   &figure_command,
    &figures_command, &export_command, &devices_command};
enum { COMMAND_COUNT = sizeof commands / sizeof commands[0] };

static const char *command_name(const void *data, size_t index) {
  (void)data;
  return index < COMMAND_COUNT ? commands[index]->name : index == COMMAND_COUNT ? "help" : NULL;
}

static const cli_command *find_command(const char *name) {
  for (size_t i = 0; i < COMMAND_COUNT; i++)
    if (strcmp(commands[i]->name, name) == 0) return commands[i];
  return NULL;
}

static int refuse_command(const char *name) {
  const char *meant = command_meant_by(name);
  if (meant == NULL) meant = hl_nearest_candidate(name, command_name, NULL);
  if (meant != NULL) return fail(EXIT_CODE_USAGE, "unknown command '%s': did you mean '%s'?", name, meant);
  if (access(name, F_OK) == 0)
    return fail(EXIT_CODE_USAGE,
                "a command is missing before '%s': 'halflight view %s' shows it, 'halflight render %s' makes "
                "a picture",
                name, name, name);
  return fail(EXIT_CODE_USAGE, "unknown command '%s': see 'halflight --help'", name);
}

static int print_help(void) {
  printf(
      "usage: halflight COMMAND ...\n\nPictures of volumes in which light is attenuated by what it "
      "passes.\n\n");
  for (size_t i = 0; i < COMMAND_COUNT; i++) {
    char usage[40];
    snprintf(usage, sizeof usage, "%s %s", commands[i]->name, commands[i]->operands);
    printf("  %-18s %s\n", usage, commands[i]->summary);
  }
  printf("  %-18s %s\n", "help TOPIC", "a command, or: presets, colormaps");
  printf("\n  %-18s %s\n  %-18s %s\n", "--help", "this text", "--version", "the version");
  printf(
      "\nexit codes: 0 done, 1 failed while running, 2 usage, 3 bad input, 4 unsupported, 130 interrupted\n");
  return finish_stdout();
}

static int print_names(const char *(*name)(size_t index)) {
  for (size_t i = 0; name(i) != NULL; i++) puts(name(i));
  return finish_stdout();
}

static int print_topic(const char *topic) {
  if (strcmp(topic, "presets") == 0) return print_names(hl_preset_name);
  if (strcmp(topic, "colormaps") == 0) return print_names(hl_colormap_name);
  const cli_command *command = find_command(topic);
  if (command == NULL) return refuse_command(topic);
  options_print_help(command);
  return finish_stdout();
}

static int run_command(const cli_command *command, int argument_count, char **arguments) {
  cli_value values[MAXIMUM_OPTIONS] = {0};
  char *operands[MAXIMUM_OPERANDS + 1] = {0};
  bool help;
  int exit_code = options_parse(command, argument_count, arguments, values, operands, &help);
  if (exit_code != EXIT_CODE_OK) return exit_code;
  return help ? print_topic(command->name) : command->run(values, operands);
}

/* Opens /dev/null for standard streams that the shell closed. Otherwise the picture's file would get the
 * descriptor of a closed stream, and messages would be written into the picture. A closed standard output
 * gets a descriptor that cannot be written, so that writing to it is reported as an error. */
static void keep_standard_streams(void) {
  for (int descriptor = 0; descriptor < 3; descriptor++)
    if (fcntl(descriptor, F_GETFD) == -1 && errno == EBADF)
      (void)open("/dev/null", descriptor == 1 ? O_RDONLY : O_RDWR);
}

/* Ignores signals that would end the program silently when a pipe is closed or a limit on file sizes is
 * reached. The write then fails instead, and the program can print why. */
static void take_errors_for_signals(void) {
  signal(SIGPIPE, SIG_IGN);
  signal(SIGXFSZ, SIG_IGN);
}

/* Finds and runs the subcommand. Returns the exit code. *command becomes the command that was run; it stays
 * null if no command was run. */
static int run_line(int argc, char **argv, const cli_command **command) {
  if (argc < 2) return fail(EXIT_CODE_USAGE, "a command is missing: see 'halflight --help'");
  const char *name = argv[1];
  bool asks_help = strcmp(name, "--help") == 0 || strcmp(name, "-h") == 0 || strcmp(name, "help") == 0;
  if (asks_help && argc == 2) return print_help();
  if (strcmp(name, "help") == 0 && argc == 3) return print_topic(argv[2]);
  if (strcmp(name, "--version") == 0 && argc == 2) {
    printf("halflight %s\n", hl_version());
    return finish_stdout();
  }
  if (asks_help || strcmp(name, "--version") == 0)
    return fail(EXIT_CODE_USAGE, "'%s' is too much after %s", argv[argc - 1], name);
  if (name[0] == '-') return fail(EXIT_CODE_USAGE, "unknown option '%s': see 'halflight --help'", name);
  *command = find_command(name);
  return *command != NULL ? run_command(*command, argc - 2, argv + 2) : refuse_command(name);
}

int main(int argc, char **argv) {
  const cli_command *command = NULL;
  hl_program_begin(&argc, &argv);
  keep_standard_streams();
  take_errors_for_signals();
  int exit_code = run_line(argc, argv, &command);
  if (exit_code != EXIT_CODE_OK && options_join(command != NULL ? command : &render_command, argc, argv))
    ranks_end_others(exit_code);
  return exit_code;
}
