/* cli/view/browser.h - opens the viewer's page in the user's browser. */
#ifndef HL_CLI_VIEW_BROWSER_H
#define HL_CLI_VIEW_BROWSER_H

#include <limits.h>

/* A file that leads the browser to the viewer's page. The page's URL holds the token. It is not put on the
 * browser's command line, which every user of the machine can read, but into this file, which only its owner
 * can read. */
typedef struct browser_page {
  char folder[PATH_MAX / 2]; /* the folder of the file; "" if there is none */
  char path[PATH_MAX];
} browser_page;

/* Opens the URL in the user's browser, by a file that leads to it and that stays until browser_forget(). If
 * there is no screen, or no browser opens, the user must open the URL. */
void browser_open(const char *url, browser_page *page);
/* Removes the file. Does nothing if there is none. */
void browser_forget(browser_page *page);

#endif
