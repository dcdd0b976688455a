/* cli/devices.c - implements `halflight devices`, which lists the GPUs that --device can name. */
#include <halflight/device.h>
#include <inttypes.h>
#include <stdio.h>

#include "commands.h"
#include "host.h"
#include "json_writer.h"

enum devices_option { DEVICES_JSON, DEVICES_OPTION_COUNT };

static const cli_option devices_options[DEVICES_OPTION_COUNT] = {
    [DEVICES_JSON] = {.name = "json", .kind = OPTION_SWITCH, .group = "Options", .help = "as JSON"}};

enum { MOST_DEVICES = 32 };

static void print_json(const hl_device *devices, size_t count, const char *missing) {
  json_writer json = {0};
  json_open_object(&json, NULL);
  json_open_array(&json, "devices");
  for (size_t i = 0; i < count; i++) {
    json_open_object(&json, NULL);
    json_text(&json, "name", devices[i].name);
    json_text(&json, "interface", devices[i].interface_name);
    json_text(&json, "version", devices[i].version);
    json_whole_number(&json, "memory_bytes", devices[i].memory_bytes);
    json_bool(&json, "processor", devices[i].processor != 0);
    json_close(&json);
  }
  json_close(&json);
  if (missing[0] != '\0') json_text(&json, "missing", missing);
  json_close(&json);
}

static void print_lines(const hl_device *devices, size_t count, const char *missing) {
  for (size_t i = 0; i < count; i++)
    printf("%s: %s, %" PRIu64 " MiB%s, %s\n", devices[i].interface_name, devices[i].name,
           devices[i].memory_bytes >> 20, devices[i].processor ? ", the processors" : "", devices[i].version);
  if (count == 0) puts("no devices: the processors make all pictures");
  if (missing[0] != '\0') printf("%s\n", missing);
}

static int run_devices(const cli_value *values, char **operands) {
  (void)operands;
  cli_host host;
  const cli_host_options options = {.subject = "devices"};
  int exit_code = host_open(&options, &host);
  if (exit_code != EXIT_CODE_OK) return exit_code;
  hl_device devices[MOST_DEVICES];
  char missing[512];
  size_t count = 0;
  hl_error error = {0};
  hl_status status = hl_devices_find(host.context, devices, MOST_DEVICES, &count, missing, sizeof missing,
                                     &error);
  if (count > MOST_DEVICES) count = MOST_DEVICES;
  if (status != HL_OK) exit_code = host_fail(&host, PHASE_SETUP, status, &error);
  else if (values[DEVICES_JSON].given) print_json(devices, count, missing);
  else print_lines(devices, count, missing);
  host_close(&host);
  return exit_code == EXIT_CODE_OK ? finish_stdout() : exit_code;
}

const cli_command devices_command = {
    .name = "devices",
    .operands = "",
    .summary = "list the GPUs that --device can name",
    .description =
        "Lists the GPUs that CUDA and OpenCL offer; --device of render, bench and "
        "view takes\na part of a name.",
    .options = devices_options,
    .option_count = DEVICES_OPTION_COUNT,
    .run = run_devices};
