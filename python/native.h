/* python/native.h - what python/native.c adds to the library's own functions, for cffi.
 *
 * The library asks every few milliseconds whether to stop, and tells its progress about as often. Each of
 * these calls into Python would wait for the interpreter's lock; so C answers most of them itself.
 */

/* A context whose callbacks lead to the functions below. */
hl_status python_context_create(hl_context **context, hl_error *error);

/* Around each call that may take long, on the thread that calls. listening: whether progress is told. */
void python_call_begin(int listening);
void python_call_end(void);

/* Lets the thread's call ask a web server for the files of the store at a URL, and for no others. url:
 * borrowed until the call ends. */
void python_call_may_ask(const char *url);

/* Makes a borrowing description tell python_array_released() when its voxels are no longer needed. */
void python_lend(hl_volume_description *description, uintptr_t key);
