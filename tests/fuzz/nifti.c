/* tests/fuzz/nifti.c - fuzz target: NIfTI 1 and 2, single files and pairs, plain and gzip. */
#include "target.h"

const uint64_t fuzz_memory_limit = 3 << 20;

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  fuzz_load_volume("v.nii", "v.img", data, size);
  return 0;
}
