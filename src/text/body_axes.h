/* text/body_axes.h - directions in a patient's body as letters: R or L (right, left), A or P (anterior,
 * posterior), S or I (superior, inferior). */
#ifndef HL_TEXT_BODY_AXES_H
#define HL_TEXT_BODY_AXES_H

#include <stdbool.h>

/* What hl_body_axes_read() accepts, for messages. */
#define HL_BODY_AXES_WANTED                                                                                  \
  "give the directions to which x, y and z of the file point, as RAS, LPS or another three of R or L, A or " \
  "P, S or I"

/* Reads three letters, in upper or lower case. axis: for each letter, the axis of the space RAS along which
 * it points; sign: 1 along this axis, -1 against it. Returns false if the text does not have three letters
 * that name three different axes. */
bool hl_body_axes_read(const char *text, int axis[3], double sign[3]);

#endif
