/* cli/openvdb.h - the context's callbacks that read OpenVDB's files by way of a converter. */
#ifndef HL_CLI_OPENVDB_H
#define HL_CLI_OPENVDB_H

#include <stdbool.h>

#include <halflight/halflight.h>

/* Runs halflight-openvdb or nanovdb_convert, if there is one. limit: the most bytes of memory that it may
 * hold and that it may write. cancelled: asked while it runs. *bytes: release them with openvdb_release(). */
hl_status openvdb_convert(const char *path, uint64_t limit, int (*cancelled)(void *user_data),
                          void *user_data, const void **bytes, size_t *byte_count, hl_error *error);
/* Whether there is a converter. */
bool openvdb_is_there(void);
void openvdb_release(const void *bytes, size_t byte_count);

#endif
