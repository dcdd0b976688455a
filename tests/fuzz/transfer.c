/* tests/fuzz/transfer.c - fuzz target: transfer-function files: Halflight's own, ParaView's and Slicer's. */
#include <string.h>

#include "target.h"

const uint64_t fuzz_memory_limit = 16 << 20;

static void check_function(const hl_transfer_function *function) {
  REQUIRE(function->unit_distance > 0);
  REQUIRE(function->opacity != NULL || function->opacity_count == 0);
  REQUIRE(function->color != NULL || function->color_count == 0);
  for (size_t n = 0; n < function->opacity_count; n++) {
    REQUIRE(function->opacity[n].opacity >= 0 && function->opacity[n].opacity <= 1);
    REQUIRE(n == 0 || function->opacity[n].value >= function->opacity[n - 1].value);
  }
  for (size_t n = 0; n < function->color_count; n++)
    for (int c = 0; c < 3; c++) REQUIRE(function->color[n].color[c] >= 0 && function->color[n].color[c] <= 1);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  size_t first = 0; /* XML and Slicer's lines of numbers have their own names */
  while (first < size && strchr(" \n\r\t", data[first]) != NULL) first++;
  const char *name = first == size || strchr("{[", data[first]) != NULL ? "f.json"
                     : data[first] == '<'                               ? "f.xml"
                                                                        : "f.vp";
  const char *path = fuzz_write_file(0, name, data, size);
  hl_transfer_function function = {0};
  hl_error error = {0};
  hl_status status = hl_transfer_function_load(fuzz_context(), path, &function, &error);
  bool made = function.opacity != NULL || function.color != NULL;
  if (fuzz_check_answer(status, &error, made || status == HL_OK)) {
    check_function(&function);
    hl_transfer_function_release(fuzz_context(), &function);
  }
  fuzz_check_nothing_held();
  return 0;
}
