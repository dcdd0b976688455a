/* web/web.h - declares the functions of the library's WebAssembly file for a page without a server. The
 * page's worker calls them (page/engine.js).
 *
 * One scene is open at a time. A call that can fail returns an hl_status; web_answer() is then its result, or
 * the error's line. Text and answers lie in the WebAssembly file's memory. */
#ifndef HL_WEB_WEB_H
#define HL_WEB_WEB_H

#include <stddef.h>
#include <stdint.h>

/* Returns whether this engine rounds a product and a sum only once, as pictures need. The result is 1 if it
 * does, and 0 if it rounds twice, as engines may choose with relaxed SIMD. */
int web_fuses(void);

/* Makes the context. The page must call this function first. mebibytes: the most memory; threads: the most
 * threads of a picture. */
int web_begin(uint32_t mebibytes, int threads);

/* These functions are for a WebAssembly file that is linked for several threads. web_helper_arrive(): a
 * helper's worker reports its number, from 0 on; returns 1 if the number is possible. web_helper_serve():
 * runs the library's threads in this worker, and does not return (platform/wasi/threads.h). */
int web_helper_arrive(int number);
void web_helper_serve(int number);

/* Allocates memory for the page, such as a helper's stack. Returns null if memory is short. */
void *web_room(size_t bytes);
void web_release(void *room);

/* Gives memory into which the caller writes a text. The memory is valid until the next call of this function.
 * Returns null if memory is short. */
char *web_text(size_t bytes);

/* Opens a file, folder or scene, whose path is the text, in place of the open scene, if it can be opened.
 * Answer: its start.json. */
int web_open(const char *title);

/* Adds the file, folder or scene at a path to the text's scene, whose volumes are the open scene's. The
 * result becomes the open scene. path_and_title: two texts, each with a zero at its end. Answer: the
 * start.json of the result. */
int web_join(size_t length, const char *path_and_title);

/* Answer: the text's scene, whose volumes are the open scene's, with all defaults written out. look_and_rig:
 * the names of a look and of a light rig that are applied first, as two texts, each with a zero at its end;
 * "" if none is applied. */
int web_complete(size_t length, const char *look_and_rig);

/* Renders the text's scene, whose volumes are the open scene's. format: "png", "npy", or "rgba" (bytes of
 * opaque sRGB, top row first). depth: bits of a PNG's channels. metadata: whether a PNG carries the scene's
 * text. moving: whether to make a quick picture, with coarser volumes if the sheets are far apart
 * (halflight/preview.h). */
int web_frame(size_t length, const char *format, int depth, int metadata, int moving);

/* Answer: the values of a plane of voxels, as slice_values() makes them (start/places.h). The text is 15
 * doubles: width, height, depth, origin, across, down and through of hl_reslice_options. number: of a volume
 * in the open scene; source: a slice_source; blend: an hl_blend; interpolate: 0 or 1. */
int web_slice(int number, int source, int blend, int interpolate);

/* Answer: the depth of the surface that the middle pixel of a picture of the text's scene shows, as
 * middle_depth() writes it. */
int web_depth(size_t length);

/* The bytes of the last answer. The library owns them. They are valid until the next call of a function that
 * returns a status. */
const unsigned char *web_answer(void);
size_t web_answer_bytes(void);

/* The number of bytes that are held for the open scene. */
double web_memory_held(void);

/* Functions that the page provides. web_cancelled() says whether the running call is not wanted any more.
 * web_progress() receives the fraction of a file that has been read. */
__attribute__((import_module("page"), import_name("cancelled"))) int web_cancelled(void);
__attribute__((import_module("page"), import_name("progress"))) void web_progress(double fraction);

#endif
