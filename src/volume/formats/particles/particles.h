/* volume/formats/particles/particles.h - makes volumes of particles for the readers of files. */
#ifndef HL_VOLUME_PARTICLES_H
#define HL_VOLUME_PARTICLES_H

#include <halflight/particles.h>

#include "core/error.h"
#include "volume/volume.h"

/* Does the work of hl_volume_from_particles() for the particles of a file. subject: starts the error lines.
 */
hl_status hl_particles_to_volume(hl_context *context, const hl_particles_description *description,
                                 const char *subject, hl_volume **volume, hl_error *error);

#endif
