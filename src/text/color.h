/* text/color.h - reads colours from text: numbers, #rrggbb and the names of CSS. */
#ifndef HL_TEXT_COLOR_H
#define HL_TEXT_COLOR_H

#include <stdbool.h>

/* Reads a colour as linear RGB. Numbers, which must lie between `low` and `high`, are linear RGB; #rgb,
 * #rrggbb and CSS names are sRGB. Returns false if the text is no colour. */
bool hl_parse_color(const char *text, double low, double high, double color[3]);

#endif
