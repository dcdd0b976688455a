/* json/sky.c - reads a scene's sky from JSON, with the image of an environment. */
#include "core/memory.h"
#include "json/parts.h"
#include "json/settings.h"

hl_status hl_json_read_sky(hl_json_reader *reader, const json_t *value, hl_sky *sky) {
  static const char *const file[] = {"file", NULL};
  if (value == NULL) return HL_OK;
  size_t mark = hl_json_enter(reader, "sky");
  hl_status status = hl_json_settings_object(reader, value, HL_SETTINGS_SKY, -1, file);
  if (status == HL_OK) status = hl_json_setting(reader, value, HL_SETTINGS_SKY, "type", sky);
  const bool image = status == HL_OK && sky->type == HL_SKY_IMAGE;
  if (status == HL_OK)
    status = hl_json_settings_object(reader, value, HL_SETTINGS_SKY, (int)sky->type, image ? file : NULL);
  if (status == HL_OK) status = hl_json_settings(reader, value, HL_SETTINGS_SKY, (int)sky->type, sky);
  if (status == HL_OK && image)
    status = hl_json_load_image(reader, value,
                                &(hl_json_image){&sky->file, &sky->pixels, &sky->width, &sky->height, 3});
  if (status == HL_OK) hl_json_leave(reader, mark);
  return status;
}

void hl_json_release_sky(hl_context *context, hl_sky *sky) {
  hl_release(context, (void *)sky->file);
  hl_release(context, (void *)sky->pixels);
}
