/* render/light_reads.h - finds which tiles of a light's shadow buffer are needed, and for how long, by a part
 * of a shared picture or by a sector of a light within the content. */
#ifndef HL_RENDER_LIGHT_READS_H
#define HL_RENDER_LIGHT_READS_H

#include "render/sweep.h"

/* Finds the array needed_until of each light whose method allows it, if the picture is shared or the light is
 * a sector. Call it after the sweep's views, its lights and the picture's surfaces have begun. Tiles that no
 * part needs are never read, so leaving them out changes no pixel. */
hl_status hl_light_reads_find(sweep *sweep, hl_error *error);

/* Adds the tiles that this part of a shared picture owns to the tiles that it needs, because other parts may
 * need the light of owned tiles. Call it after the lights' surfaces have begun. */
hl_status hl_light_reads_find_owned(sweep *sweep, hl_error *error);

/* Counts the memory that hl_light_reads_find() and hl_light_reads_find_owned() take, for lights whose shadows
 * are planned. Sets no pointers. */
void hl_light_reads_count(sweep *sweep, hl_layout *layout);

#endif
