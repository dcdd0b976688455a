/* server/connections.h - the connections that are open, and how long each may take. */
#ifndef HL_SERVER_CONNECTIONS_H
#define HL_SERVER_CONNECTIONS_H

#include <pthread.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <microhttpd.h>

enum {
  MOST_CONNECTIONS = 256,          /* at once */
  MOST_WAITING = 128,              /* of them: that wait for a request */
  IDLE_SECONDS = 20,               /* that a request may take to come, and a connection may be silent */
  LEAST_BYTES_PER_SECOND = 1 << 14 /* of a body, beyond IDLE_SECONDS */
};

/* A connection of a browser, or of anybody else on this machine. */
typedef struct connection_place {
  int socket;
  int state;         /* connections.c; 0: the place is free */
  double since;      /* in this state, by server_seconds() */
  uint64_t received; /* bytes of the body */
} connection_place;

typedef struct connection_table {
  pthread_mutex_t lock;
  connection_place places[MOST_CONNECTIONS]; /* under `lock` */
  unsigned long long turned_away;            /* connections that ended for others; under `lock` */
} connection_table;

/* Seconds since some time in the past. */
double server_seconds(void);

bool connections_begin(connection_table *table);
void connections_end(connection_table *table);

/* user_data: the table. libmicrohttpd calls this when a connection begins, and before it closes its socket.
 */
void connection_changed(void *user_data, struct MHD_Connection *connection, void **place,
                        enum MHD_ConnectionNotificationCode code);

/* The connection has shown the token, and goes on to the body of its request; all of it is there; the request
 * has ended. */
void connection_sends(connection_table *table, struct MHD_Connection *connection);
void connection_is_answered(connection_table *table, struct MHD_Connection *connection);
void connection_is_idle(connection_table *table, struct MHD_Connection *connection);
/* Bytes of the body have come. */
void connection_received(connection_table *table, struct MHD_Connection *connection, size_t bytes);

int connection_socket(struct MHD_Connection *connection);

/* Ends connections that are beyond their deadline. Call it some times a second. */
void connections_expire(connection_table *table);

/* open, waiting: those that are, now; turned_away: all that have ended in favour of others. */
void connections_count(connection_table *table, int *open, int *waiting, unsigned long long *turned_away);

/* Whoever is at the other end has closed the connection. */
bool peer_is_gone(int socket);

#endif
