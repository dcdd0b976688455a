/* guess/styles.h - describes styles: looks that a user asks for by name, independently of the kind of data in
 * the volume. */
#ifndef HL_GUESS_STYLES_H
#define HL_GUESS_STYLES_H

#include "guess/look.h"

/* A style by its number (hl_style) or its name (hl_style_find); null if no style has the number or the name.
 */
const hl_look *hl_style(size_t index);
const hl_look *hl_style_find(const char *name);

/* The style that has this name in hl_look_name(); null for "auto". Other names are refused. */
hl_status hl_style_named(const char *name, const hl_look **style, hl_error *error);

/* Writes a style's opacities. The colours are the colours of the look that suits the volume (base), unless
 * the style has colours of its own. If the style is the look that suits the volume, that look is written. */
void hl_style_write(const hl_look *style, const hl_look *base, hl_function_writer *w);

#endif
