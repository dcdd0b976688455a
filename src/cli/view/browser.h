/* cli/view/browser.h - the browser that shows the viewer's page. */
#ifndef HL_CLI_VIEW_BROWSER_H
#define HL_CLI_VIEW_BROWSER_H

#include <limits.h>

/* A file that leads the browser to the page. Command lines can be read by every user of the machine, so the
 * page's URL, which holds the token, stands in this file, which its owner alone can read. */
typedef struct browser_page {
  char folder[PATH_MAX / 2]; /* folder of the file; "": there is none */
  char path[PATH_MAX];
} browser_page;

/* Opens the URL in the user's browser, by way of a file that stays until browser_forget(). Where there is
 * no screen, or no browser opens, the user must open the URL. */
void browser_open(const char *url, browser_page *page);
/* Removes the file; harmless where there is none. */
void browser_forget(browser_page *page);

#endif
