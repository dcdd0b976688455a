/* python/native.h - declares for cffi the functions that python/native.c adds to the library's own functions.
 *
 * The library asks every few milliseconds whether to stop, and reports its progress about as often. A call of
 * Python would have to wait for the interpreter's lock each time. Therefore the C code answers most of these
 * calls itself. */

/* A context whose callbacks lead to the functions below. */
hl_status python_context_create(hl_context **context, hl_error *error);

/* Python calls these two functions before and after each call of the library that may take long, on the same
 * thread. listening: whether the progress is reported to Python. */
void python_call_begin(int listening);
void python_call_end(void);

/* Lets the thread's call ask web servers for the files of the stores at URLs, and for no others. urls:
 * ended by null, borrowed until the call ends. */
void python_call_may_ask(const char *const *urls);

/* Sets a description of borrowed voxels so that the library calls python_array_released() when it no longer
 * needs the voxels. */
void python_lend(hl_volume_description *description, uintptr_t key);

/* Reads a colour as linear RGB: #rgb, #rrggbb, or a name of CSS. Returns 0 if the text is no such colour. */
int python_color(const char *text, double color[3]);
