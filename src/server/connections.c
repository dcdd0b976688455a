/* server/connections.c - keeps the table of open connections, and ends connections that take too long.
 *
 * A connection is a stranger until it has sent a request with the token. Strangers are accepted, because a
 * browser is a stranger at first. But only MOST_WAITING connections may wait for a request. If more
 * connections wait, a new connection takes the place of the stranger that has waited for the longest time.
 * After that, no connection is accepted for a moment. A browser sends its request at once, and so this
 * request is read before its connection can become the one that has waited for the longest time. Heads and
 * bodies of requests have deadlines. A connection is ended by shutdown(), which its own thread of
 * libmicrohttpd notices. */
#define _GNU_SOURCE
#include "connections.h"

#include <poll.h>
#include <sys/socket.h>
#include <time.h>

#include "platform/clock.h"

/* The state of a connection. */
enum {
  CONNECTION_FREE,
  CONNECTION_STRANGER,
  CONNECTION_IDLE,
  CONNECTION_SENDS,
  CONNECTION_ANSWERED,
  CONNECTION_ENDS
};

bool connections_begin(connection_table *table) { return pthread_mutex_init(&table->lock, NULL) == 0; }
void connections_end(connection_table *table) { pthread_mutex_destroy(&table->lock); }

static bool waits(const connection_place *c) {
  return c->state == CONNECTION_STRANGER || c->state == CONNECTION_IDLE;
}

static void end(connection_place *c) {
  c->state = CONNECTION_ENDS;
  shutdown(c->socket, SHUT_RDWR);
}

/* Chooses the waiting connection that ends to make room for another one. Among the strangers, it is the
 * connection that has waited for the longest time. If there is no stranger, it is that connection among all
 * others. */
static connection_place *least_missed(connection_table *table) {
  connection_place *best = NULL;
  for (int n = 0; n < MOST_CONNECTIONS; n++) {
    connection_place *c = &table->places[n];
    if (!waits(c)) continue;
    bool stranger = c->state == CONNECTION_STRANGER,
         best_stranger = best != NULL && best->state == CONNECTION_STRANGER;
    if (best == NULL || (stranger && !best_stranger) || (stranger == best_stranger && c->since < best->since))
      best = c;
  }
  return best;
}

/* Takes a place for a new connection; null if there is none. *crowded: set to whether a waiting connection
 * had to end. */
static connection_place *let_in(connection_table *table, int socket, bool *crowded) {
  connection_place *taken = NULL;
  int waiting = 0;
  for (int n = 0; n < MOST_CONNECTIONS; n++) {
    if (taken == NULL && table->places[n].state == CONNECTION_FREE) taken = &table->places[n];
    waiting += waits(&table->places[n]);
  }
  *crowded = waiting >= MOST_WAITING;
  if (*crowded) {
    end(least_missed(table));
    table->turned_away++;
  }
  if (taken != NULL)
    *taken = (connection_place){.socket = socket, .state = CONNECTION_STRANGER, .since = hl_clock_seconds()};
  return taken;
}

int connection_socket(struct MHD_Connection *connection) {
  const union MHD_ConnectionInfo *info = MHD_get_connection_info(connection,
                                                                 MHD_CONNECTION_INFO_CONNECTION_FD);
  return info != NULL ? (int)info->connect_fd : -1;
}

void connection_changed(void *user_data, struct MHD_Connection *connection, void **place,
                        enum MHD_ConnectionNotificationCode code) {
  const struct timespec moment = {.tv_nsec = 1000000};
  connection_table *table = user_data;
  bool crowded = false;
  pthread_mutex_lock(&table->lock);
  if (code == MHD_CONNECTION_NOTIFY_STARTED) {
    int socket = connection_socket(connection);
    connection_place *c = let_in(table, socket, &crowded);
    if (c == NULL) shutdown(socket, SHUT_RDWR);
    *place = c;
  } else if (*place != NULL) {
    *(connection_place *)*place = (connection_place){.state = CONNECTION_FREE};
    *place = NULL;
  }
  pthread_mutex_unlock(&table->lock);
  /* The sleeping thread is the thread that accepts connections, so that no new connections are accepted
   * during the sleep. */
  if (crowded) nanosleep(&moment, NULL);
}

/* Changes a connection's state, unless the connection is ending. */
static void enter(connection_table *table, struct MHD_Connection *connection, int state) {
  const union MHD_ConnectionInfo *info = MHD_get_connection_info(connection,
                                                                 MHD_CONNECTION_INFO_SOCKET_CONTEXT);
  connection_place *c = info != NULL ? info->socket_context : NULL;
  if (c == NULL) return;
  pthread_mutex_lock(&table->lock);
  if (c->state != CONNECTION_ENDS) {
    c->state = state;
    c->since = hl_clock_seconds();
    c->received = 0;
  }
  pthread_mutex_unlock(&table->lock);
}

void connection_sends(connection_table *table, struct MHD_Connection *connection) {
  enter(table, connection, CONNECTION_SENDS);
}
void connection_is_answered(connection_table *table, struct MHD_Connection *connection) {
  enter(table, connection, CONNECTION_ANSWERED);
}
void connection_is_idle(connection_table *table, struct MHD_Connection *connection) {
  enter(table, connection, CONNECTION_IDLE);
}

void connection_received(connection_table *table, struct MHD_Connection *connection, size_t bytes) {
  const union MHD_ConnectionInfo *info = MHD_get_connection_info(connection,
                                                                 MHD_CONNECTION_INFO_SOCKET_CONTEXT);
  connection_place *c = info != NULL ? info->socket_context : NULL;
  if (c == NULL) return;
  pthread_mutex_lock(&table->lock);
  c->received += bytes;
  pthread_mutex_unlock(&table->lock);
}

void connections_expire(connection_table *table) {
  double now = hl_clock_seconds();
  pthread_mutex_lock(&table->lock);
  for (int n = 0; n < MOST_CONNECTIONS; n++) {
    connection_place *c = &table->places[n];
    double allowed = IDLE_SECONDS;
    if (c->state == CONNECTION_SENDS) allowed += (double)c->received / LEAST_BYTES_PER_SECOND;
    if ((waits(c) || c->state == CONNECTION_SENDS) && now - c->since > allowed) end(c);
  }
  pthread_mutex_unlock(&table->lock);
}

void connections_count(connection_table *table, int *open, int *waiting, unsigned long long *turned_away) {
  *open = *waiting = 0;
  pthread_mutex_lock(&table->lock);
  for (int n = 0; n < MOST_CONNECTIONS; n++) {
    *open += table->places[n].state != CONNECTION_FREE;
    *waiting += waits(&table->places[n]);
  }
  *turned_away = table->turned_away;
  pthread_mutex_unlock(&table->lock);
}

bool peer_is_gone(int socket) {
  struct pollfd peer = {.fd = socket, .events = POLLRDHUP};
  return poll(&peer, 1, 0) > 0 && (peer.revents & (POLLRDHUP | POLLHUP | POLLERR)) != 0;
}
