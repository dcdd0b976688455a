/* cli/view/token.h - keeps the token of a viewer's URL for the next viewer on the same port. */
#ifndef HL_CLI_VIEW_TOKEN_H
#define HL_CLI_VIEW_TOKEN_H

#include <stdbool.h>

enum { VIEW_TOKEN_DIGITS = 32 };

/* Gets the token that the user's last viewer on this port had, or makes a new one and keeps it. So an open
 * page continues to work when the viewer is started again. The token lies in XDG_RUNTIME_DIR, which only the
 * user can enter, and which is removed when the user logs out. Returns false if there is no such folder, or
 * if the token's file cannot be trusted or written. */
bool view_token_of_port(int port, char token[VIEW_TOKEN_DIGITS + 1]);

#endif
