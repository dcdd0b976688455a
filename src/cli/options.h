/* cli/options.h - describes command-line options by tables.
 *
 * A subcommand states its options once, in a table indexed by its own enum; parsing, help texts and error
 * messages all come from that table. Long options only (and a letter for a few): --name value, --name=value,
 * -o value. Negative numbers are values. "--" ends the options. */
#ifndef HL_CLI_OPTIONS_H
#define HL_CLI_OPTIONS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <halflight/settings.h>

typedef enum cli_option_kind {
  OPTION_SWITCH,  /* takes no value */
  OPTION_TEXT,    /* any text except an empty one */
  OPTION_CHOICE,  /* one of `choices`; if `choices` is null, one of the choices of the library's option of
                   * this name */
  OPTION_NUMBERS, /* `count` numbers joined by `separator`; or one of `choices`, if there are any */
  OPTION_BYTES,   /* a whole number with an optional K, M, G or T (powers of 1024) */
  OPTION_COLOR /* linear R,G,B or a grey, #rgb, #rrggbb, a CSS name; or one of `choices`, if there are any */
} cli_option_kind;

/* The value of a choice that this version does not have yet: the choice is not listed, and is refused when
 * given. */
enum { CHOICE_RESERVED = -1 };

typedef hl_setting_choice cli_choice; /* a null name ends the list */

typedef struct cli_option {
  const char *name; /* without the dashes */
  const char *also; /* another word for the option, which other programs use; null if there is none */
  char letter;      /* the letter of the short form; 0 if there is none */
  cli_option_kind kind;
  const char *argument; /* the option's value as help shows it; null if the option is a switch, or if help
                         * lists its choices */
  const char *help;     /* lines, the first one short */
  const char *hint;     /* a text that is added to the error if the option has no value; null if there is
                         * none */
  const char *group;    /* heading above this option in help; null if the option belongs to the same group as
                         * the option before it */
  const cli_choice *choices;
  int count;           /* for OPTION_NUMBERS: the number of numbers, 1 to 3 */
  char separator;      /* between the numbers: ',' or 'x' */
  bool whole;          /* whole numbers only */
  bool even;           /* for OPTION_NUMBERS: whether a single number stands for all numbers */
  bool above;          /* low itself is excluded */
  bool percent;        /* for OPTION_NUMBERS: whether each number may also be a percentile, from 0% to 100% */
  double low, high;    /* the accepted range */
  const char *setting; /* the key of a scene's setting, whose range and choices replace the members above; or
                        * null */
  hl_setting_kind setting_kind;
  const char *if_picture; /* OPTION_COLOR: the advice for a user who gives a picture's file; null if there is
                           * none */
  bool named;             /* for OPTION_NUMBERS: whether NAME= may stand before the numbers */
  bool optional; /* for OPTION_NUMBERS: whether the numbers may be left out; they are then 0, and `count` is
                  * 0 */
  const char *implied; /* the value that the option has where no value follows it: at the end of the command
                        * or before another option. If null, a value must follow */
  bool repeatable;     /* whether the option may be given several times; every text is kept */
  bool reserved;       /* whether this version does not have the option yet: it is not shown in help, and is
                        * refused if it is given */
  bool joins;          /* whether processes of an MPI launcher wait for each other if they are given this
                        * option */
} cli_option;

enum { MAXIMUM_REPEATS = 32 };

typedef struct cli_value {
  bool given;
  const char *text;                   /* the value as it was typed; for a repeatable option the last value */
  const char *texts[MAXIMUM_REPEATS]; /* the values as typed; [count] */
  int count;
  bool chosen; /* whether one of the choices was given; if so, `choice` is its value */
  int choice;
  double number[3];
  bool percent[3]; /* the number is a percentile */
  uint64_t bytes;
} cli_value;

typedef struct cli_command {
  const char *name;
  const char *operands; /* as help shows them: "INPUT" */
  int operand_count;    /* the least number of operands */
  int operand_most;     /* the greatest number of operands; 0 if there must be exactly operand_count */
  const char *summary;  /* the command's line in the list of commands */
  const char *description;
  const cli_option *options;
  size_t option_count;
  const cli_option *shared; /* the table of another subcommand, some of whose options this subcommand has,
                             * too; null if there is none */
  size_t shared_count;
  bool (*has_shared)(size_t row); /* whether this subcommand has the option in this row of `shared` */
  /* values: [option_count + shared_count]; values for the command's own table come first. operands: ended by
   * null. Returns the exit code */
  int (*run)(const cli_value *values, char **operands);
} cli_command;

enum { MAXIMUM_OPTIONS = 128, MAXIMUM_OPERANDS = 16 };

/* Returns whether one of the arguments is an option that joins processes, or is nearest to such an option.
 * The arguments may have mistakes. */
bool options_join(const cli_command *command, int argument_count, char **arguments);

/* Parses the arguments after the subcommand's name. Returns EXIT_CODE_OK, or another exit code after printing
 * an error. At --help or -h *help is set and parsing stops. */
int options_parse(const cli_command *command, int argument_count, char **arguments, cli_value *values,
                  char **operands, bool *help);

/* Prints the help text of a subcommand on stdout. */
void options_print_help(const cli_command *command);

#endif
