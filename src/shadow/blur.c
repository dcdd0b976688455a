/* shadow/blur.c - the blur box of a given variance. */
#include <math.h>

#include "shadow/blur.h"

/* Weights of 1 out to r have the variance r (r + 1) / 3. With weight e at r + 1 on both sides, n = 2 r + 1
 * and variance v: v (n + 2 e) = n r (r + 1) / 3 + 2 e (r + 1)^2, which gives e (derived). */
blur_box hl_blur_box_of_variance(double variance) {
  int most = BLUR_GREATEST_REACH - 2, reach = (int)fmin(sqrt(3 * variance + 0.25) - 0.5, most);
  double whole = reach * (reach + 1) / 3.0, width = 2 * reach + 1;
  double edge = 0.5 * width * (variance - whole) / ((reach + 1.0) * (reach + 1) - variance);
  if (reach == most || !(edge < 1)) edge = reach == most ? 0 : 1;
  return (blur_box){reach, (float)edge, (float)(1 / (width + 2 * edge))};
}
