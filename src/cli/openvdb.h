/* cli/openvdb.h - declares the context's callbacks that read OpenVDB's files through a converter. */
#ifndef HL_CLI_OPENVDB_H
#define HL_CLI_OPENVDB_H

#include <stdbool.h>

#include <halflight/halflight.h>

/* Runs halflight-openvdb or nanovdb_convert, if there is one. limit: the greatest number of bytes of memory
 * that the converter may hold, and that it may write. cancelled: a function that is asked, while the
 * converter runs, whether it should end. *bytes: release them with openvdb_release(). */
hl_status openvdb_convert(const char *path, uint64_t limit, int (*cancelled)(void *user_data),
                          void *user_data, const void **bytes, size_t *byte_count, hl_error *error);
/* Returns whether there is a converter. */
bool openvdb_is_there(void);
void openvdb_release(const void *bytes, size_t byte_count);

#endif
