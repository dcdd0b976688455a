/* volume/io/xml.h - reads the tags of an XML file one by one. The functions read the XML of VTK's and OME's
 * files, and are safe for all other XML files.
 *
 * Text between tags, comments and processing instructions are skipped. Document type declarations (and with
 * them entity definitions and external references) and CDATA are refused. */
#ifndef HL_VOLUME_XML_H
#define HL_VOLUME_XML_H

#include "volume/io/stream.h"

enum { HL_XML_TAG_BYTES = 8192, HL_XML_ATTRIBUTES = 32 };

typedef struct hl_xml_tag {
  char text[HL_XML_TAG_BYTES]; /* the tag's text, into which the names and values point */
  const char *name;
  bool is_start, is_end; /* whether the tag begins, and whether it ends, an element; both are true for
                          * <name/> */
  int attribute_count;
  struct {
    const char *name, *value; /* the five predefined entities are resolved */
  } attribute[HL_XML_ATTRIBUTES];
} hl_xml_tag;

/* Reads the next tag. The stream continues after the tag. *ended: set to whether the file has no further
 * tag. */
hl_status hl_xml_next_tag(hl_stream *stream, hl_xml_tag *tag, bool *ended, hl_error *error);

/* The value of an attribute; null if the tag does not have it. */
const char *hl_xml_attribute(const hl_xml_tag *tag, const char *name);

#endif
