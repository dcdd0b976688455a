/* server/module.c - see module.h. */
#include "module.h"

extern const server_module halflight_viewer;
__attribute__((visibility("default")))
const server_module halflight_viewer = {server_run, server_progress, server_is_outdated, server_warned};
