/* cli/options.c - parses a subcommand's arguments by its table of options. */
#include "options.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <halflight/compose.h>

#include "message.h"
#include "suggest.h"
#include "text/color.h"
#include "text/edit_distance.h"
#include "text/plain.h"

static const char *choice_name(const void *choices, size_t index) {
  const cli_choice *choice = (const cli_choice *)choices + index;
  while (choice->value == CHOICE_RESERVED) choice++;
  return choice->name;
}

/* The number of rows of a command: the rows of its own table and of the table that it shares. */
static size_t row_count(const cli_command *command) { return command->option_count + command->shared_count; }

/* The option in a row; null if the command does not have the option of this row. */
static const cli_option *option_in(const cli_command *command, size_t row) {
  if (row < command->option_count) return &command->options[row];
  row -= command->option_count;
  return command->has_shared(row) ? &command->shared[row] : NULL;
}

/* Gives the names of options, from which suggestions are made. Options that the command does not have, and
 * reserved options, are skipped. */
static const char *option_name(const void *data, size_t index) {
  const cli_command *command = data;
  size_t count = row_count(command);
  for (; index < count; index++) {
    const cli_option *option = option_in(command, index);
    if (option != NULL && !option->reserved) return option->name;
  }
  return index == count ? "help" : NULL;
}

/* Writes the names of an option's choices, without the reserved ones: "off, hard, soft". */
static void list_choices(const cli_option *option, const char *separator, char *text, size_t size) {
  size_t used = 0;
  text[0] = '\0';
  for (const cli_choice *choice = option->choices; choice->name != NULL && used < size; choice++)
    if (choice->value != CHOICE_RESERVED)
      used += (size_t)snprintf(text + used, size - used, "%s%s", used > 0 ? separator : "", choice->name);
}

/* Writes in words which values an option of the kind OPTION_NUMBERS accepts: "a whole number from 1 to
 * 64". */
static void describe_numbers(const cli_option *option, char *text, size_t size) {
  const char *kind = option->whole ? "whole number" : "number";
  char range[80];
  if (isinf(option->high) && isinf(option->low)) snprintf(range, sizeof range, "that is finite");
  else if (isinf(option->high))
    snprintf(range, sizeof range, "%s %.9g", option->above ? "above" : "of at least", option->low);
  else if (option->above) snprintf(range, sizeof range, "above %.9g, up to %.9g", option->low, option->high);
  else snprintf(range, sizeof range, "from %.9g to %.9g", option->low, option->high);
  size_t used;
  if (option->count == 1) used = (size_t)snprintf(text, size, "a %s %s", kind, range);
  else
    used = (size_t)snprintf(text, size, "%s%d %ss joined by '%c', each %s",
                            option->even ? "one number, or " : "", option->count, kind, option->separator,
                            option->percent      ? "finite or a percentile from 0% to 100%"
                            : isinf(option->low) ? "finite"
                                                 : range);
  if (option->choices != NULL && used < size) {
    char choices[200];
    list_choices(option, ", ", choices, sizeof choices);
    snprintf(text + used, size - used, ", or %s", choices);
  }
}

/* Whether a text ends like the name of a picture's file. */
static bool names_picture(const char *text) {
  static const char *const endings[] = {".png", ".jpg", ".jpeg", ".exr", ".hdr", ".tif", ".tiff"};
  const char *dot = strrchr(text, '.');
  for (size_t n = 0; dot != NULL && n < sizeof endings / sizeof *endings; n++)
    if (hl_plain_equal(dot, endings[n])) return true;
  return false;
}

static int refuse_value(const cli_option *option, const char *text) {
  for (const cli_choice *choice = option->choices; choice != NULL && choice->name != NULL; choice++)
    if (choice->value == CHOICE_RESERVED && strcmp(choice->name, text) == 0)
      return fail(EXIT_CODE_UNSUPPORTED, "--%s %s is not yet in this version (%s)", option->name, text,
                  hl_version());
  char accepted[300];
  const char *meant = NULL;
  switch (option->kind) {
    case OPTION_CHOICE:
      list_choices(option, ", ", accepted, sizeof accepted);
      meant = value_meant_by(option->name, text);
      if (meant == NULL) meant = hl_nearest_candidate(text, choice_name, option->choices);
      return fail(EXIT_CODE_USAGE, "--%s: '%s' is none of %s%s%s%s", option->name, text, accepted,
                  meant != NULL ? " (did you mean " : "", meant != NULL ? meant : "",
                  meant != NULL ? "?)" : "");
    case OPTION_NUMBERS:
      describe_numbers(option, accepted, sizeof accepted);
      return fail(EXIT_CODE_USAGE, "--%s: '%s' is not %s", option->name, text, accepted);
    case OPTION_BYTES:
      return fail(EXIT_CODE_USAGE, "--%s: '%s' is not a whole number above 0 with an optional K, M, G or T",
                  option->name, text);
    case OPTION_COLOR:
      if (option->if_picture != NULL && names_picture(text))
        return fail(EXIT_CODE_USAGE, "--%s: '%s' is no colour: %s", option->name, text, option->if_picture);
      return fail(
          EXIT_CODE_USAGE,
          "--%s: '%s' is no colour: give linear R,G,B each from %.9g to %.9g, #rrggbb, or a CSS name%s",
          option->name, text, option->low, option->high, option->choices != NULL ? ", or transparent" : "");
    case OPTION_SWITCH:
    case OPTION_TEXT: break;
  }
  return fail(EXIT_CODE_USAGE, "--%s: '%s' is not %s", option->name, text, option->argument);
}

/* Reads a choice, in upper or lower case. *text becomes the choice's own name. */
static bool parse_choice(const cli_option *option, const char **text, cli_value *value) {
  for (const cli_choice *choice = option->choices; choice != NULL && choice->name != NULL; choice++)
    if (choice->value != CHOICE_RESERVED && hl_plain_equal(choice->name, *text)) {
      value->chosen = true;
      value->choice = choice->value;
      *text = choice->name;
      return true;
    }
  return false;
}

static bool parse_numbers(const cli_option *option, const char *text, cli_value *value) {
  const char *equals = option->named ? strchr(text, '=') : NULL, *at = equals != NULL ? equals + 1 : text;
  for (int i = 0; i < option->count; i++) {
    size_t length = strspn(at, option->whole ? "0123456789" : "0123456789+-.eE");
    char *end;
    double number = hl_plain_number(at, &end);
    if (length == 0 || end != at + length || !isfinite(number)) return false;
    value->percent[i] = option->percent && *end == '%';
    if (value->percent[i] && (*at == '-' || number > 100)) return false;
    if (number < option->low || number > option->high || (option->above && number == option->low))
      return false;
    value->number[i] = number;
    end += value->percent[i];
    if (option->even && i == 0 && *end == '\0') {
      for (int other = 1; other < option->count; other++) value->number[other] = number;
      return true;
    }
    if (*end != (i + 1 < option->count ? option->separator : '\0')) return false;
    at = end + 1;
  }
  return true;
}

static bool parse_bytes(const char *text, cli_value *value) {
  static const char suffixes[] = "KMGT";
  uint64_t bytes = 0;
  const char *at = text;
  for (; *at >= '0' && *at <= '9'; at++) {
    if (bytes > (UINT64_MAX - 9) / 10) return false;
    bytes = bytes * 10 + (uint64_t)(*at - '0');
  }
  if (at == text || bytes == 0) return false;
  if (*at != '\0') {
    const char *suffix = strchr(suffixes, *at >= 'a' && *at <= 'z' ? *at - 'a' + 'A' : *at);
    if (suffix == NULL || at[1] != '\0') return false;
    int shift = 10 * (int)(suffix - suffixes + 1);
    if (bytes > UINT64_MAX >> shift) return false;
    bytes <<= shift;
  }
  value->bytes = bytes;
  return true;
}

static int parse_value(const cli_option *option, const char *text, cli_value *value) {
  bool good = false;
  switch (option->kind) {
    case OPTION_SWITCH: good = true; break;
    case OPTION_TEXT: good = text[0] != '\0'; break;
    case OPTION_CHOICE: good = parse_choice(option, &text, value); break;
    case OPTION_NUMBERS:
      good = parse_choice(option, &text, value) || parse_numbers(option, text, value);
      break;
    case OPTION_BYTES: good = parse_bytes(text, value); break;
    case OPTION_COLOR:
      good = parse_choice(option, &text, value) ||
             hl_parse_color(text, option->low, option->high, value->number);
      break;
  }
  if (!good) return refuse_value(option, text);
  if (option->repeatable && value->count == MAXIMUM_REPEATS)
    return fail(EXIT_CODE_USAGE, "--%s is given more than %d times", option->name, MAXIMUM_REPEATS);
  value->texts[value->count++] = text;
  value->given = true;
  value->text = text;
  return EXIT_CODE_OK;
}

/* Returns whether a text looks like an option. A value may begin with a dash, too: "-30,20", "-.5". */
static bool looks_like_option(const char *text) {
  return text[0] == '-' && text[1] != '\0' && strchr("0123456789.", text[1]) == NULL;
}

/* Returns whether a text has only characters that a number may have. */
static bool is_number(const char *text) {
  return text[0] != '\0' && text[strspn(text, "0123456789+-.eE")] == '\0';
}

/* Returns whether the first `length` characters of a name are this word. word: may be null. */
static bool is_word(const char *word, const char *name, size_t length) {
  return word != NULL && strlen(word) == length && strncmp(word, name, length) == 0;
}

/* Finds the row of an option by its name or its other word (cli_option.also). An option with this name comes
 * before an option with this other word. Returns the number of rows if there is no such option. */
static size_t find_option(const cli_command *command, const char *name, size_t length) {
  size_t row = 0, also = row_count(command);
  for (; row < row_count(command); row++) {
    const cli_option *option = option_in(command, row);
    if (option == NULL) continue;
    if (is_word(option->name, name, length)) return row;
    if (is_word(option->also, name, length)) also = row;
  }
  return also;
}

static size_t find_letter(const cli_command *command, char letter) {
  size_t row = 0;
  for (; row < row_count(command); row++) {
    const cli_option *option = option_in(command, row);
    if (option != NULL && option->letter == letter && letter != '\0') break;
  }
  return row;
}

/* A copy of an option. It has the range and the choices of its scene setting; without a setting, the choices
 * of the library's option of the same name. */
static cli_option with_setting(const cli_option *option) {
  cli_option full = *option;
  const hl_setting *setting = option->setting != NULL ? hl_setting_find(option->setting_kind, option->setting)
                                                      : NULL;
  if (full.choices == NULL) full.choices = hl_option_choices(option->name);
  if (setting == NULL) return full;
  if (setting->choices != NULL) full.choices = setting->choices;
  full.low = setting->low;
  full.high = setting->high;
  full.above = setting->open_low != 0;
  return full;
}

/* Copies the name in a long option: "size" of "--size=8x8". Returns its length; 0 if the argument is no long
 * option. */
static size_t name_in(const char *argument, char *name, size_t size) {
  size_t length = argument[0] == '-' && argument[1] == '-' ? strcspn(argument + 2, "=") : 0;
  snprintf(name, size, "%.*s", (int)(length < size ? length : size - 1), length > 0 ? argument + 2 : "");
  return length;
}

static int refuse_unknown(const cli_command *command, const char *argument) {
  char name[80], json[160];
  size_t length = name_in(argument, name, sizeof name);
  const char *meant = length > 0 ? hl_nearest_candidate(name, option_name, command) : NULL;
  const char *word = length > 0 ? name : argument + 1; /* "j" of "-j" */
  const int typed = (int)strcspn(argument, "=");
  const char *does = synonym_of(word, option_name, command);
  const char *answer = does == NULL ? answer_to(word) : NULL;
  if (answer != NULL)
    return fail(EXIT_CODE_USAGE, "unknown option '%.*s' of %s: %s", typed, argument, command->name, answer);
  if (does == NULL && strcmp(command->name, "render") == 0 && scene_setting_of(word, json, sizeof json))
    return fail(EXIT_CODE_USAGE,
                "unknown option '%.*s' of render: a scene says %s; --print-scene writes a scene", typed,
                argument, json);
  const bool differ = does != NULL && meant != NULL && strncmp(does, meant, strcspn(does, " ")) != 0;
  if (differ)
    return fail(EXIT_CODE_USAGE, "unknown option '%.*s' of %s: did you mean --%s, or --%s?", typed, argument,
                command->name, does, meant);
  if (does != NULL) meant = does;
  if (meant != NULL)
    return fail(EXIT_CODE_USAGE, "unknown option '%.*s' of %s: did you mean --%s?", typed, argument,
                command->name, meant);
  return fail(EXIT_CODE_USAGE, "unknown option '%s' of %s: see 'halflight help %s'", argument, command->name,
              command->name);
}

static int refuse_missing(const cli_option *option) {
  char accepted[300] = "";
  if (option->argument == NULL) list_choices(option, ", ", accepted, sizeof accepted);
  else if (option->kind == OPTION_NUMBERS && option->count == 1)
    describe_numbers(option, accepted, sizeof accepted);
  return fail(EXIT_CODE_USAGE, "--%s needs a value: %s%s%s%s", option->name,
              option->argument != NULL ? option->argument : "",
              option->argument != NULL && accepted[0] != '\0' ? ", " : "", accepted,
              option->hint != NULL ? option->hint : "");
}

/* Parses the option at arguments[*index] and its value. *index becomes the index of the last argument that
 * was used. */
static int parse_option(const cli_command *command, int argument_count, char **arguments, int *index,
                        cli_value *values) {
  const char *argument = arguments[*index], *attached = NULL;
  size_t row;
  if (argument[1] == '-') {
    size_t length = strcspn(argument + 2, "=");
    row = find_option(command, argument + 2, length);
    attached = argument[2 + length] == '=' ? argument + 3 + length : NULL;
  } else {
    row = find_letter(command, argument[1]);
    attached = argument[2] != '\0' ? argument + 2 : NULL;
  }
  if (row == row_count(command)) return refuse_unknown(command, argument);
  const cli_option full = with_setting(option_in(command, row)), *option = &full;
  if (option->reserved)
    return fail(EXIT_CODE_UNSUPPORTED, "--%s is not yet in this version (%s)", option->name, hl_version());
  cli_value *value = &values[row];
  if (value->given && !option->repeatable)
    return fail(EXIT_CODE_USAGE, "--%s is given twice: give it once", option->name);
  if (option->kind == OPTION_SWITCH) {
    if (attached != NULL)
      return fail(EXIT_CODE_USAGE, "--%s takes no value, but '%s' was given", option->name, attached);
    return parse_value(option, "", value);
  }
  if (attached == NULL && option->optional &&
      (*index + 1 >= argument_count || !is_number(arguments[*index + 1]))) {
    value->given = true;
    return EXIT_CODE_OK;
  }
  if (attached == NULL) {
    cli_value chosen = {0}; /* a value such as "-y" may be one of the choices */
    attached = *index + 1 < argument_count ? arguments[*index + 1] : NULL;
    if (attached == NULL || (looks_like_option(attached) && !parse_choice(option, &attached, &chosen)))
      return option->implied != NULL ? parse_value(option, option->implied, value) : refuse_missing(option);
    ++*index;
  }
  return parse_value(option, attached, value);
}

bool options_join(const cli_command *command, int argument_count, char **arguments) {
  for (int i = 0; i < argument_count; i++) {
    char name[80];
    if (name_in(arguments[i], name, sizeof name) == 0) continue;
    size_t row = find_option(command, name, strlen(name));
    const char *meant = row == row_count(command) ? hl_nearest_candidate(name, option_name, command) : NULL;
    if (meant != NULL) row = find_option(command, meant, strlen(meant));
    if (row < row_count(command) && option_in(command, row)->joins) return true;
  }
  return false;
}

int options_parse(const cli_command *command, int argument_count, char **arguments, cli_value *values,
                  char **operands, bool *help) {
  int operand_count = 0;
  bool only_operands = false;
  *help = false;
  for (int i = 0; i < argument_count; i++) {
    char *argument = arguments[i];
    if (!only_operands && strcmp(argument, "--") == 0) {
      only_operands = true;
    } else if (!only_operands && (strcmp(argument, "--help") == 0 || strcmp(argument, "-h") == 0)) {
      *help = true;
      return EXIT_CODE_OK;
    } else if (!only_operands && argument[0] == '-' && argument[1] != '\0') {
      int exit_code = parse_option(command, argument_count, arguments, &i, values);
      if (exit_code != EXIT_CODE_OK) return exit_code;
    } else if (argument[0] == '\0') {
      return fail(EXIT_CODE_USAGE, "an empty name was given, '': %s needs %s", command->name,
                  command->operands);
    } else if (operand_count ==
               (command->operand_most > 0 ? command->operand_most : command->operand_count)) {
      return fail(EXIT_CODE_USAGE, "'%s' is too much: %s takes %s only; see 'halflight help %s'", argument,
                  command->name, command->operands, command->name);
    } else {
      operands[operand_count++] = argument;
    }
  }
  if (operand_count < command->operand_count)
    return fail(EXIT_CODE_USAGE, "%s needs %s: see 'halflight help %s'", command->name, command->operands,
                command->name);
  return EXIT_CODE_OK;
}

/* Writes the first column of an option in the help: "--shadows off|hard|soft". */
static void option_heading(const cli_option *option, char *text, size_t size) {
  size_t used = (size_t)(option->letter != '\0'
                             ? snprintf(text, size, "-%c, --%s", option->letter, option->name)
                             : snprintf(text, size, "--%s", option->name));
  if (option->kind == OPTION_SWITCH) return;
  char choices[200] = "";
  if (option->argument == NULL) list_choices(option, "|", choices, sizeof choices);
  snprintf(text + used, size - used, " %s", option->argument != NULL ? option->argument : choices);
}

enum { HELP_COLUMN = 38 };

static void print_option(const char *heading, const char *help) {
  printf("  %s", heading);
  size_t at = 2 + strlen(heading);
  if (at >= HELP_COLUMN) {
    putchar('\n');
    at = 0;
  }
  for (const char *line = help; *line != '\0';) {
    int length = (int)strcspn(line, "\n");
    printf("%*s%.*s\n", (int)(HELP_COLUMN - at), "", length, line);
    line += line[length] == '\n' ? length + 1 : length;
    at = 0;
  }
}

/* Prints an option, below the heading of the group that it begins; group: null if the option begins no
 * group. */
static void print_row(const cli_option *listed, const char *group) {
  const cli_option option = with_setting(listed);
  char heading[120];
  if (group != NULL) printf("\n%s\n", group);
  option_heading(&option, heading, sizeof heading);
  print_option(heading, option.help);
}

void options_print_help(const cli_command *command) {
  printf("usage: halflight %s %s [OPTION ...]\n\n%s\n", command->name, command->operands,
         command->description);
  const char *group = NULL; /* whose heading is due */
  for (size_t row = 0; row < row_count(command); row++) {
    const cli_option *listed = option_in(command, row);
    const bool shared = row >= command->option_count;
    if (shared && command->shared[row - command->option_count].group != NULL)
      group = command->shared[row - command->option_count].group;
    if (listed == NULL || listed->reserved) continue;
    if (!shared) group = listed->group;
    print_row(listed, group);
    if (listed->also != NULL && find_option(command, listed->also, strlen(listed->also)) == row)
      printf("%*salso --%s\n", HELP_COLUMN, "", listed->also);
    group = NULL;
  }
  print_option("-h, --help", "this text");
}
