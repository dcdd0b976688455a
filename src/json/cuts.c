/* json/cuts.c - reads the cuts of a volume or a scene from JSON. */
#include "core/memory.h"
#include "json/parts.h"
#include "json/settings.h"

/* The keys that each type of cut needs; null ends each list. */
static const char *const needed[][3] = {[HL_CUT_PLANE] = {"point", "normal", NULL},
                                        [HL_CUT_BOX] = {"min", "max", NULL},
                                        [HL_CUT_SPHERE] = {"center", "radius", NULL}};

static hl_status read_cut(hl_json_reader *reader, const json_t *value, hl_cut *cut) {
  hl_cut_defaults(cut);
  hl_status status = hl_json_settings_object(reader, value, HL_SETTINGS_CUT, -1, NULL);
  if (status == HL_OK && json_object_get(value, "type") == NULL)
    status = hl_json_fail(reader, HL_ERROR_INPUT, "type",
                          "is missing: give \"plane\", \"box\" or \"sphere\"");
  if (status == HL_OK) status = hl_json_setting(reader, value, HL_SETTINGS_CUT, "type", cut);
  if (status == HL_OK) status = hl_json_settings_object(reader, value, HL_SETTINGS_CUT, (int)cut->type, NULL);
  for (const char *const *key = needed[cut->type]; status == HL_OK && *key != NULL; key++)
    if (json_object_get(value, *key) == NULL)
      status = hl_json_fail(reader, HL_ERROR_INPUT, *key, "is missing: give %s and %s", needed[cut->type][0],
                            needed[cut->type][1]);
  return status == HL_OK ? hl_json_settings(reader, value, HL_SETTINGS_CUT, (int)cut->type, cut) : status;
}

hl_status hl_json_read_cuts(hl_json_reader *reader, const json_t *value, const hl_cut **made,
                            size_t *made_count) {
  if (value == NULL) return HL_OK;
  size_t mark = hl_json_enter(reader, "cuts"), count = json_array_size(value);
  hl_status status = hl_json_array(reader, value, 0, HL_LIMIT_CUTS);
  if (status != HL_OK) return status;
  hl_cut *cuts = hl_allocate_zeroed(reader->context, count, sizeof *cuts);
  if (cuts == NULL) return hl_fail_memory(reader->error, count * sizeof *cuts, "cuts");
  *made = cuts;
  *made_count = count;
  for (size_t i = 0; i < count; i++) {
    size_t inner = hl_json_enter_index(reader, i);
    if ((status = read_cut(reader, json_array_get(value, i), &cuts[i])) != HL_OK) return status;
    hl_json_leave(reader, inner);
  }
  hl_json_leave(reader, mark);
  return HL_OK;
}
