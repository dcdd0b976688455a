/* scene/light/point.c - implements the type of light that is a sphere or a point, and shines to all sides.
 * The light looks like the disk of its radius that faces the observer. */
#include "scene/light/light_kind.h"

const light_kind hl_light_kind_point = {.sphere = true,
                                        .deviations = 4,
                                        .check_reach = hl_check_round_reach,
                                        .shape = hl_round_shape,
                                        .spread = hl_round_spread,
                                        .point = hl_round_point,
                                        .plane = hl_round_plane,
                                        .apparent_lengths = hl_apparent_diameter};
