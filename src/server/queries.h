/* server/queries.h - reads the parameters in the address of a request. */
#ifndef HL_SERVER_QUERIES_H
#define HL_SERVER_QUERIES_H

#include "parts.h"

struct MHD_Connection;

/* The text of a parameter, which lives as long as the request; null if it is absent. */
const char *query_text(struct MHD_Connection *connection, const char *name);
/* Reads a whole number from low to high. Returns `standard` if the parameter is absent, and -1 if it is no
 * such number. */
long long query_number(struct MHD_Connection *connection, const char *name, long long low, long long high,
                       long long standard);
bool is_page_name(const char *name);
bool is_picture_format(const char *format);
bool is_film_format(const char *format);

/* Reads the parameters of a frame, whose scene is the request's body. Numbers and choices that cannot be read
 * become -1. If `number` cannot be read, it becomes 0 or more than MOST_NUMBER. body: [length]; it is
 * borrowed. */
frame_request query_frame(struct MHD_Connection *connection, const char *body, size_t length);
/* Returns whether a request for a frame names a page and has a number. */
bool names_page(const frame_request *wanted);
/* Returns whether the parameters of the overlays could be read. */
bool names_overlay(const frame_request *wanted);
/* Returns whether the frame's format can have overlays, which are drawn with 8 bits per channel. */
bool overlay_fits(const frame_request *wanted);
/* Reads the plane that a query describes. Returns false if the query describes no plane, or a plane that is
 * too large. */
bool query_slice(struct MHD_Connection *connection, slice_request *wanted);
/* Reads a film's parameters. Numbers that cannot be read become -1. With too many keys, the number of frames
 * becomes -1. format: borrowed. */
film_request query_film(struct MHD_Connection *connection, const char *format);

#endif
