/* guess/rigs.h - the names of light rigs, as choices of an option; hl_scene_light_rig() makes their lights.
 */
#ifndef HL_GUESS_RIGS_H
#define HL_GUESS_RIGS_H

#include <halflight/settings.h>

extern const hl_setting_choice hl_light_rig_choices[]; /* the last choice has a null name */

#endif
