/* guess/looks.h - chooses the looks by which volumes of each kind are shown by default. */
#ifndef HL_GUESS_LOOKS_H
#define HL_GUESS_LOOKS_H

#include "guess/analysis.h"
#include "guess/look.h"

/* The look that shows a volume if no look is asked for. A label map has the look of labels. file: as in
 * hl_scene_volume. */
const hl_look *hl_look_automatic(const hl_volume *volume, const char *file, const hl_data_analysis *analysis);

/* The look for a volume's values; file: as in hl_scene_volume. */
const hl_look *hl_look_for(const hl_volume *volume, const char *file, const hl_data_analysis *analysis);

/* Returns true for the scan of a body, with or without its skull. file: as in hl_scene_volume. */
bool hl_is_body(const hl_volume *volume, const char *file, const hl_data_analysis *analysis);

/* Gives a bare volume the shading and the material of its look. */
void hl_look_material(const hl_look *look, hl_scene_volume *volume);

/* Makes the transfer function of a look; *function owns its points. style: the style (styles.h) whose
 * opacities take the place of the look's; null if there is none. */
hl_status hl_look_write(const hl_look *look, const hl_look *style, hl_context *context,
                        const hl_volume *volume, const hl_data_analysis *analysis,
                        hl_transfer_function *function, hl_error *error);

#endif
