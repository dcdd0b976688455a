/* server/bases.c - reads scenes that a page sends as differences from an earlier scene, which it has sent as
 * a whole.
 *
 * While something moves, a page sends many scenes that hardly differ. The server keeps each page's base. The
 * base is the newest scene that the page has sent as a whole, and the number of that scene's frame. link.js
 * makes the differences. A difference is {"to": VALUE}, {"gone": 1} or, for an object or an array, {"in":
 * {KEY: DIFFERENCE}}. */
#define _GNU_SOURCE
#include <jansson.h>
#include <stdlib.h>
#include <string.h>

#include "parts.h"

void base_forget(server_page *page) {
  free(page->base);
  page->base = NULL;
  page->base_number = 0;
}

void base_keep(server *s, server_page *page, const frame_request *request) {
  /* One byte is added for a terminating zero, which the body of a request does not have. */
  char *text = malloc(request->length + 1);
  if (text != NULL) text[request->length] = '\0';
  if (text != NULL && request->length > 0) memcpy(text, request->text, request->length);
  pthread_mutex_lock(&s->pages_lock);
  if (text != NULL && request->number > page->base_number) {
    free(page->base);
    page->base = text;
    page->base_number = request->number;
    text = NULL;
  }
  pthread_mutex_unlock(&s->pages_lock);
  free(text);
}

static json_t *changed(json_t *from, json_t *part);

/* Applies a difference to one member of an object, or to one element of an array. Returns false if there is
 * no such element, or the difference is malformed. */
static bool change_element(json_t *whole, const char *key, json_t *part) {
  if (json_is_array(whole)) {
    char *end;
    size_t index = strtoul(key, &end, 10);
    return end > key && *end == '\0' && index < json_array_size(whole) &&
           json_array_set_new(whole, index, changed(json_array_get(whole, index), part)) == 0;
  }
  if (json_object_get(part, "gone") != NULL) return json_object_del(whole, key) == 0;
  return json_object_set_new(whole, key, changed(json_object_get(whole, key), part)) == 0;
}

/* Applies a difference to a value. Returns a reference that the caller owns. Returns null if the difference
 * is malformed. `from` may be changed, and may be null. */
static json_t *changed(json_t *from, json_t *part) {
  json_t *to = json_object_get(part, "to"), *in = json_object_get(part, "in"), *inner;
  const char *key;
  if (to != NULL) return json_incref(to);
  if (!json_is_object(in)) return NULL;
  json_object_foreach(in, key, inner) if (!change_element(from, key, inner)) return NULL;
  return json_incref(from);
}

char *base_changed(server *s, server_page *page, const frame_request *request, server_answer *answer) {
  pthread_mutex_lock(&s->pages_lock);
  bool known = page->base != NULL && page->base_number == (unsigned long long)request->base;
  char *base = known ? strdup(page->base) : NULL, *text = NULL;
  pthread_mutex_unlock(&s->pages_lock);
  if (base == NULL) {
    refuse_line(answer, 409,
                "the viewer no longer holds the scene that this one differs from: send it whole");
    return NULL;
  }
  json_t *from = json_loads(base, JSON_REJECT_DUPLICATES, NULL);
  json_t *part = json_loadb(request->text, request->length, JSON_REJECT_DUPLICATES, NULL);
  json_t *scene = changed(from, part);
  if (scene != NULL) text = json_dumps(scene, JSON_COMPACT);
  if (text == NULL) refuse_line(answer, 400, "the body is no difference from the scene of the frame ?base=N");
  json_decref(scene);
  json_decref(part);
  json_decref(from);
  free(base);
  return text;
}
