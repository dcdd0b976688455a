/* web/web.h - the library for a page without a server: the functions of the WebAssembly file that the
 * page's worker calls (page/engine.js).
 *
 * One scene is open at a time. A call that can fail returns an hl_status; web_answer() is then its result, or
 * the error's line. Text and answers lie in the WebAssembly file's memory. */
#ifndef HL_WEB_WEB_H
#define HL_WEB_WEB_H

#include <stddef.h>
#include <stdint.h>

/* Whether this engine rounds a product and a sum once, together, as pictures need: 1. With relaxed SIMD,
 * engines may choose to round twice: 0. */
int web_fuses(void);

/* Makes the context, before all other calls. mebibytes: of memory at most; threads: of a picture at most. */
int web_begin(uint32_t mebibytes, int threads);

/* For a file that is linked for several threads. web_helper_arrive(): a helper's worker tells its number,
 * from 0 on; returns 1 if the library knows this number. web_helper_serve(): the worker serves the library;
 * the function does not return (platform/wasi/threads.h). */
int web_helper_arrive(int number);
void web_helper_serve(int number);

/* Allocates memory for the page, such as a helper's stack; null: there is no memory. */
void *web_room(size_t bytes);
void web_release(void *room);

/* Memory into which the caller writes a text. It holds until the next call of this function; null: there is
 * no memory. */
char *web_text(size_t bytes);

/* Opens the file, folder or scene that the text names, in place of what is open, if it can. Answer:
 * start.json. */
int web_open(const char *title);

/* Adds the file, folder or scene at a path to the text's scene, whose volumes are those of the open scene.
 * The result becomes the open scene. path_and_title: two texts, each with a zero at its end. Answer:
 * start.json. */
int web_join(size_t length, const char *path_and_title);

/* Answer: the text's scene, whose volumes are those of the open scene, with all defaults written out.
 * look_and_rig: the names of a look and of a light rig that are applied first, as two texts, each with a
 * zero at its end; "" for none. */
int web_complete(size_t length, const char *look_and_rig);

/* Renders the text's scene, which names the volumes of the open one. format: "png", "npy", or "rgba", bytes
 * of opaque sRGB, top row first. depth: bits of a PNG's codes. metadata: 0, without the scene's text. moving:
 * not 0, a quick picture, of coarser volumes where the sheets are wide (halflight/preview.h). */
int web_frame(size_t length, const char *format, int depth, int metadata, int moving);

/* Answer: the values of a plane of voxels, as slice_values() makes them (start/places.h). The text is 15
 * doubles: width, height, depth, origin, across, down and through of hl_reslice_options. number: of a volume
 * of what is open; of_mask: 1, the label map that masks it; blend: an hl_blend; interpolate: 0 or 1. */
int web_slice(int number, int of_mask, int blend, int interpolate);

/* Answer: the depth of what the middle pixel of a picture of the text's scene shows, as middle_depth() writes
 * it. */
int web_depth(size_t length);

/* The bytes that the last call answered. The library owns them. They are valid until the next call of a
 * function that returns a status. */
const unsigned char *web_answer(void);
size_t web_answer_bytes(void);

/* Bytes held for what is open. */
double web_memory_held(void);

/* Functions that the page gives. web_cancelled() says whether the running call is no longer wanted.
 * web_progress() receives the fraction of a file that has been read. */
__attribute__((import_module("page"), import_name("cancelled"))) int web_cancelled(void);
__attribute__((import_module("page"), import_name("progress"))) void web_progress(double fraction);

#endif
