/* gpu/kernels/trial.h - defines a function whose arithmetic tests a device. It uses every operation that
 * occurs in the kernels. The host compiles the same text (render/device_trial.c) and compares the bits of the
 * results. */
#ifndef HL_GPU_TRIAL_H
#define HL_GPU_TRIAL_H

#include "gpu/kernels/numbers.h"

#define TRIAL_RESULTS 10

DEVICE void try_numbers(float a, float b, float c, float result[TRIAL_RESULTS]) {
  float size = magnitude(a);
  result[0] = fused(a, b, c);
  result[1] = divided(a, b);
  result[2] = root(size);
  result[3] = exp_negative(limited(size, 0.0f, 1000.0f));
  result[4] = log_of_two(limited(size, 1e-30f, 1e30f));
  result[5] = (float)(int)limited(a, -2e9f, 2e9f) + (float)whole_below(limited(b, -2e9f, 2e9f));
  result[6] = lesser(a, b) - greater(b, c);
  result[7] = a * b + c;
  result[8] = power_of_part(limited(size, 0.0f, 1.0f), limited(magnitude(b), 0.0f, 10.0f));
  result[9] = (a - b) * 1e-38f;
}

#endif
