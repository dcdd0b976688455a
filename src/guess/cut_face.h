/* guess/cut_face.h - finds where a ray meets the faces of a volume's cuts and of its clip box. */
#ifndef HL_GUESS_CUT_FACE_H
#define HL_GUESS_CUT_FACE_H

#include <halflight/scene.h>

#include "core/vector.h"
#include "scene/geometry/cut.h"

/* Returns whether a ray crosses a face of a cut or of the clip box between two points of index space. The
 * second point must not be removed by cuts or the box. cuts: [volume->cut_count]; the shapes of the volume's
 * cuts. *outward: the face's normal: a gradient in index space that points away from the matter that
 * remains. */
bool hl_cut_face_between(const hl_scene_volume *volume, const cut_shape *cuts, vec3 before, vec3 here,
                         vec3 *outward);

#endif
