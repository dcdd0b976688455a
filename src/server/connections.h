/* server/connections.h - keeps the table of open connections, and ends connections that take too long. */
#ifndef HL_SERVER_CONNECTIONS_H
#define HL_SERVER_CONNECTIONS_H

#include <pthread.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <microhttpd.h>

enum {
  MOST_CONNECTIONS = 256, /* the most connections at once */
  MOST_WAITING = 128,     /* the greatest number of connections that may wait for a request */
  IDLE_SECONDS = 20,      /* the number of seconds within which a request must arrive; the number of seconds
                           * for which a connection may be silent */
  LEAST_BYTES_PER_SECOND = 1 << 14 /* the least speed at which a body must arrive after IDLE_SECONDS */
};

/* A connection that a browser, or any other program on this machine, has made. */
typedef struct connection_place {
  int socket;
  int state;         /* one of the states in connections.c; if 0, this place is free */
  double since;      /* time at which the state began, by hl_clock_seconds() */
  uint64_t received; /* number of bytes of the body that have arrived */
} connection_place;

typedef struct connection_table {
  pthread_mutex_t lock;
  connection_place places[MOST_CONNECTIONS]; /* guarded by `lock` */
  /* Number of connections that were ended to make room for others; guarded by `lock`. */
  unsigned long long turned_away;
} connection_table;

bool connections_begin(connection_table *table);
void connections_end(connection_table *table);

/* Adds a connection to the table, or removes it. user_data: the table. libmicrohttpd calls the function
 * when a connection begins, and before it closes its socket. */
void connection_changed(void *user_data, struct MHD_Connection *connection, void **place,
                        enum MHD_ConnectionNotificationCode code);

/* These functions tell the table what a connection does now. connection_sends(): the connection has shown the
 * token, and the body of its request follows. connection_is_answered(): all of the body has arrived.
 * connection_is_idle(): the request has ended. */
void connection_sends(connection_table *table, struct MHD_Connection *connection);
void connection_is_answered(connection_table *table, struct MHD_Connection *connection);
void connection_is_idle(connection_table *table, struct MHD_Connection *connection);
/* Notes that some bytes of the body have arrived. */
void connection_received(connection_table *table, struct MHD_Connection *connection, size_t bytes);

int connection_socket(struct MHD_Connection *connection);

/* Ends connections that are beyond their deadline. Call it some times a second. */
void connections_expire(connection_table *table);

/* Counts connections. open: the number of connections that are open now. waiting: the number of connections
 * that wait for a request. turned_away: the number of all connections that were ended to make room for
 * others. */
void connections_count(connection_table *table, int *open, int *waiting, unsigned long long *turned_away);

/* Returns whether the other end has closed the connection. */
bool peer_is_gone(int socket);

#endif
