/* scene/light/light_kinds.h - the registry of types of light: the enumerator, and the name that scene files
 * use. The file of a type "rect" is light/rect.c, its table hl_light_kind_rect (light_kind.h).
 */
/* clang-format off */
#define HL_LIGHT_KINDS                              \
  HL_LIGHT_KIND(HL_LIGHT_DIRECTIONAL, directional)  \
  HL_LIGHT_KIND(HL_LIGHT_POINT, point)              \
  HL_LIGHT_KIND(HL_LIGHT_SPOT, spot)                \
  HL_LIGHT_KIND(HL_LIGHT_RECT, rect)                \
  HL_LIGHT_KIND(HL_LIGHT_DISK, disk)                \
  HL_LIGHT_KIND(HL_LIGHT_POLYGON, polygon)
