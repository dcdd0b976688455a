/* server/module.h - declares the functions of the viewer's module that `halflight view` calls.
 *
 * The server's libraries (libmicrohttpd, and with it GnuTLS) make a thousand allocations before main(). So
 * the server is no part of the program, and only `halflight view` loads it. */
#ifndef HL_SERVER_MODULE_H
#define HL_SERVER_MODULE_H

#include "server.h"

/* File and symbol. */
#define SERVER_MODULE_FILE "halflight-viewer.so"
#define SERVER_MODULE_NAME "halflight_viewer"

typedef struct server_module {
  bool (*run)(const server_options *options, char *problem, size_t problem_size); /* the module's function
                                                                                   * server_run() */
  void (*progress)(const char *stage, double fraction);                           /* server_progress() */
  bool (*is_outdated)(void);                                                      /* the module's function
                                                                                   * server_is_outdated() */
  void (*warned)(const char *message);                                            /* server_warned() */
} server_module;

#endif
