/* volume/io/xml.c - implements a small tokeniser for untrusted XML. */
#include "volume/io/xml.h"

#include <string.h>

#include "volume/io/text.h"

static hl_status fail(const hl_stream *stream, const char *message, hl_error *error) {
  return hl_fail_offset(error, HL_ERROR_INPUT, (int64_t)stream->offset, "%s, byte %llu: %s", stream->path,
                        (unsigned long long)stream->offset, message);
}

/* Moves the stream to the next character c. *found: set to false if the rest of the stream has no character
 * c. */
static hl_status skip_to(hl_stream *stream, char c, bool *found, hl_error *error) {
  *found = false;
  while (!*found) {
    const unsigned char *bytes;
    size_t available;
    hl_status status = hl_stream_peek(stream, 1, &bytes, &available, error);
    if (status != HL_OK || available == 0) return status;
    const unsigned char *place = memchr(bytes, c, available);
    *found = place != NULL;
    hl_stream_take(stream, place == NULL ? available : (size_t)(place - bytes));
  }
  return HL_OK;
}

/* Moves the stream past the next occurrence of the text `ending`, which must end with '>'. */
static hl_status skip_past(hl_stream *stream, const char *ending, hl_error *error) {
  size_t length = strlen(ending);
  for (;;) {
    bool found;
    hl_status status = skip_to(stream, ending[0], &found, error);
    if (status != HL_OK) return status;
    const unsigned char *bytes;
    size_t available;
    status = hl_stream_peek(stream, length, &bytes, &available, error);
    if (status != HL_OK) return status;
    if (available < length) return fail(stream, "a comment or instruction does not end", error);
    bool here = memcmp(bytes, ending, length) == 0;
    hl_stream_take(stream, here ? length : 1);
    if (here) return HL_OK;
  }
}

/* The length of the tag that begins at `bytes`, with '<' and '>'; 0 if the tag does not end within `length`
 * bytes. */
static size_t tag_length(const unsigned char *bytes, size_t length) {
  unsigned char quote = 0;
  for (size_t n = 1; n < length; n++) {
    if (quote != 0) {
      if (bytes[n] == quote) quote = 0;
    } else if (bytes[n] == '"' || bytes[n] == '\'') {
      quote = bytes[n];
    } else if (bytes[n] == '>') {
      return n + 1;
    }
  }
  return 0;
}

/* Reads a character reference, such as "&#181;" or "&#xB5;", and writes the character to *out as UTF-8, which
 * is never longer than the reference. Returns the reference's length; 0 if the text is no character
 * reference. */
static size_t resolve_number(const char *value, char **out) {
  bool hex = value[1] == '#' && (value[2] == 'x' || value[2] == 'X');
  size_t n = hex ? 3 : 2, digits = 0;
  uint32_t code = 0;
  if (value[1] != '#') return 0;
  for (; digits < 6; n++, digits++) {
    const char *all = "0123456789abcdef",
               c = value[n] >= 'A' && value[n] <= 'F' ? (char)(value[n] + 32) : value[n];
    const char *found = c != 0 ? strchr(all, c) : NULL;
    if (found == NULL || (!hex && found - all > 9)) break;
    code = code * (hex ? 16 : 10) + (uint32_t)(found - all);
  }
  if (digits == 0 || value[n] != ';' || code < ' ' || code > 0xffff) return 0;
  if (code < 0x80) *(*out)++ = (char)code;
  else if (code < 0x800) *(*out)++ = (char)(0xc0 | code >> 6);
  else {
    *(*out)++ = (char)(0xe0 | code >> 12);
    *(*out)++ = (char)(0x80 | (code >> 6 & 0x3f));
  }
  if (code >= 0x80) *(*out)++ = (char)(0x80 | (code & 0x3f));
  return n + 1;
}

/* Replaces &lt; &gt; &amp; &quot; &apos; and character references in place; other entities are not changed.
 */
static void resolve_entities(char *value) {
  static const struct {
    const char *name;
    char character;
  } entities[] = {{"&lt;", '<'}, {"&gt;", '>'}, {"&amp;", '&'}, {"&quot;", '"'}, {"&apos;", '\''}};
  char *out = value;
  while (*value != 0) {
    size_t length = *value == '&' ? resolve_number(value, &out) : 0;
    for (size_t n = 0; *value == '&' && length == 0 && n < sizeof entities / sizeof *entities; n++)
      if (strncmp(value, entities[n].name, strlen(entities[n].name)) == 0) {
        length = strlen(entities[n].name);
        *out++ = entities[n].character;
      }
    if (length == 0) *out++ = *value++;
    value += length;
  }
  *out = 0;
}

static bool ends_name(char c) { return c == 0 || hl_is_space(c) || c == '=' || c == '/'; }

/* Separates the attribute name="value" at *cursor from the rest of the tag, and moves *cursor past the
 * attribute. Returns false if the attribute is malformed. */
static bool cut_attribute(char **cursor, hl_xml_tag *tag) {
  if (tag->attribute_count == HL_XML_ATTRIBUTES) return false;
  char *name = *cursor, *end = name;
  while (!ends_name(*end)) end++;
  char *equals = end;
  while (hl_is_space(*equals)) equals++;
  if (end == name || *equals != '=') return false;
  char *value = equals + 1;
  while (hl_is_space(*value)) value++;
  char *closing = *value == '"' || *value == '\'' ? strchr(value + 1, *value) : NULL;
  if (closing == NULL) return false;
  *end = *closing = 0;
  resolve_entities(value + 1);
  tag->attribute[tag->attribute_count].name = name;
  tag->attribute[tag->attribute_count].value = value + 1;
  tag->attribute_count++;
  *cursor = closing + 1;
  return true;
}

/* Parses tag->text, the characters between '<' and '>'. */
static bool cut_tag(hl_xml_tag *tag) {
  char *cursor = tag->text;
  tag->attribute_count = 0;
  tag->is_start = *cursor != '/';
  tag->is_end = !tag->is_start;
  if (tag->is_end) cursor++;
  tag->name = cursor;
  while (!ends_name(*cursor)) cursor++;
  if (cursor == tag->name) return false;
  for (;;) {
    char *after_name = cursor;
    while (hl_is_space(*cursor)) *cursor++ = 0;
    if (*cursor == 0) return true;
    if (*cursor == '/') {
      *cursor++ = 0;
      tag->is_end = true;
      return *cursor == 0;
    }
    if (cursor == after_name || !cut_attribute(&cursor, tag)) return false;
  }
}

hl_status hl_xml_next_tag(hl_stream *stream, hl_xml_tag *tag, bool *ended, hl_error *error) {
  for (;;) {
    bool found;
    const unsigned char *bytes;
    size_t available;
    hl_status status = skip_to(stream, '<', &found, error);
    *ended = status == HL_OK && !found;
    if (status != HL_OK || *ended) return status;
    status = hl_stream_peek(stream, HL_XML_TAG_BYTES, &bytes, &available, error);
    if (status != HL_OK) return status;
    if (available >= 4 && memcmp(bytes, "<!--", 4) == 0) {
      hl_stream_take(stream, 4);
      status = skip_past(stream, "-->", error);
      if (status != HL_OK) return status;
      continue;
    }
    if (available >= 2 && bytes[1] == '?') {
      status = skip_past(stream, "?>", error);
      if (status != HL_OK) return status;
      continue;
    }
    if (available >= 2 && bytes[1] == '!')
      return fail(stream, "document type declarations and CDATA are not read", error);
    size_t length = tag_length(bytes, available < HL_XML_TAG_BYTES ? available : HL_XML_TAG_BYTES);
    if (length == 0) return fail(stream, "a tag does not end", error);
    memcpy(tag->text, bytes + 1, length - 2);
    tag->text[length - 2] = 0;
    if (!cut_tag(tag)) return fail(stream, "expected <name attribute=\"value\"> or </name>", error);
    hl_stream_take(stream, length);
    return HL_OK;
  }
}

const char *hl_xml_attribute(const hl_xml_tag *tag, const char *name) {
  for (int n = 0; n < tag->attribute_count; n++)
    if (strcmp(tag->attribute[n].name, name) == 0) return tag->attribute[n].value;
  return NULL;
}
