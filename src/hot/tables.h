/* hot/tables.h - declares the tables of hot functions. Each room has one table for each instruction set.
 *
 * A file ROOM.c of this folder is compiled once for each instruction set, with the set's name as HL_HOT_SET.
 * The file defines the table HL_HOT(ROOM). tables.c joins the tables of each instruction set. */
#ifndef HL_HOT_TABLES_H
#define HL_HOT_TABLES_H

#include "render/hot.h"
#include "shadow_sublights/sublight_field.h"

#define HL_HOT_NAME(room, set) hl_hot_##room##_##set
#define HL_HOT_DECLARE(set)                                    \
  extern const grid_functions HL_HOT_NAME(grid, set);          \
  extern const view_functions HL_HOT_NAME(view, set);          \
  extern const field_functions HL_HOT_NAME(field, set);        \
  extern const fill_functions HL_HOT_NAME(fill, set);          \
  extern const surface_functions HL_HOT_NAME(surface, set);    \
  extern const shadow_functions HL_HOT_NAME(shadow, set);      \
  extern const sublight_functions HL_HOT_NAME(sublights, set); \
  extern const render_functions HL_HOT_NAME(render, set)

#ifdef HL_HOT_SET
#define HL_HOT_OF(room, set)   HL_HOT_NAME(room, set)
#define HL_HOT(room)           HL_HOT_OF(room, HL_HOT_SET)
#define HL_HOT_DECLARE_OF(set) HL_HOT_DECLARE(set)
HL_HOT_DECLARE_OF(HL_HOT_SET);
#endif

#endif
