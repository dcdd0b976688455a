/* tests/fuzz/dicom.c - fuzz target: DICOM files and zip archives of them, and a folder of two files. */
#include "target.h"

const uint64_t fuzz_memory_limit = 6 << 20;

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  fuzz_load_volume("v.dcm", "w.dcm", data, size);
  hl_volume *volume = NULL;
  hl_error error = {0};
  hl_status status = hl_volume_load(fuzz_context(), fuzz_folder(), &volume, &error);
  fuzz_check_answer(status, &error, volume != NULL);
  hl_volume_release(volume);
  fuzz_check_nothing_held();
  return 0;
}
