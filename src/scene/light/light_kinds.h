/* scene/light/light_kinds.h - gives the list of the types of light: the enumerator, the name in scene files,
 * and the settings that only lights of this type have. For example, the type "rect" has the file light/rect.c
 * and the table hl_light_kind_rect (light_kind.h). The build reads the names of types from this list. */
#ifndef HL_SCENE_LIGHT_LIGHT_KINDS_H
#define HL_SCENE_LIGHT_LIGHT_KINDS_H

/* Groups of settings that only some types of light have (settings_table.c). */
enum light_settings {
  LIGHT_POSITION = 1,
  LIGHT_DIRECTION = 2,
  LIGHT_ANGULAR_DIAMETER = 4,
  LIGHT_RADIUS = 8,
  LIGHT_NORMAL = 16,
  LIGHT_EDGES = 32,
  LIGHT_CONE = 64
};

/* Calls a macro for each type of light. KIND: a macro of four arguments, of which `with` is the first. */
/* clang-format off */
#define HL_LIGHT_KINDS(KIND, with)                                                           \
  KIND(with, HL_LIGHT_DIRECTIONAL, directional, LIGHT_DIRECTION | LIGHT_ANGULAR_DIAMETER)    \
  KIND(with, HL_LIGHT_POINT, point, LIGHT_POSITION | LIGHT_RADIUS)                           \
  KIND(with, HL_LIGHT_SPOT, spot, LIGHT_POSITION | LIGHT_DIRECTION | LIGHT_RADIUS | LIGHT_CONE) \
  KIND(with, HL_LIGHT_RECT, rect, LIGHT_POSITION | LIGHT_EDGES)                              \
  KIND(with, HL_LIGHT_DISK, disk, LIGHT_POSITION | LIGHT_NORMAL | LIGHT_RADIUS)              \
  KIND(with, HL_LIGHT_POLYGON, polygon, 0)
/* clang-format on */

#endif
