/* cli/view/browser.c - opens the viewer's page in the user's browser. */
#define _GNU_SOURCE
#include "browser.h"

#include <fcntl.h>
#include <spawn.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#include "cli/message.h"

extern char **environ;

static bool has_screen(void) {
  const char *x11 = getenv("DISPLAY"), *wayland = getenv("WAYLAND_DISPLAY");
  return (x11 != NULL && x11[0] != '\0') || (wayland != NULL && wayland[0] != '\0');
}

/* A folder for files of this user, in which mkdtemp() makes a folder that nobody else can enter. */
static const char *private_place(void) {
  static const char *const names[] = {"XDG_RUNTIME_DIR", "TMPDIR"};
  for (size_t n = 0; n < sizeof names / sizeof *names; n++) {
    const char *folder = getenv(names[n]);
    if (folder != NULL && folder[0] == '/' && access(folder, W_OK | X_OK) == 0) return folder;
  }
  return "/tmp";
}

static bool write_page(const char *url, browser_page *page) {
  if (snprintf(page->folder, sizeof page->folder, "%s/halflight-view-XXXXXX", private_place()) >=
          (int)sizeof page->folder ||
      mkdtemp(page->folder) == NULL) {
    page->folder[0] = '\0';
    return false;
  }
  snprintf(page->path, sizeof page->path, "%s/open.html", page->folder);
  int descriptor = open(page->path, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, S_IRUSR | S_IWUSR);
  if (descriptor < 0) return false;
  int length = dprintf(descriptor,
                       "<!doctype html>\n<meta charset=\"utf-8\">\n<title>Halflight</title>\n"
                       "<meta name=\"referrer\" content=\"no-referrer\">\n"
                       "<meta http-equiv=\"refresh\" content=\"0; url=%s\">\n<a href=\"%s\">Halflight</a>\n",
                       url, url);
  return (close(descriptor) == 0) & (length > 0);
}

/* The browser's messages are discarded. */
static bool start_browser(const char *path) {
  char *arguments[] = {"xdg-open", (char *)path, NULL};
  posix_spawn_file_actions_t actions;
  pid_t child;
  if (posix_spawn_file_actions_init(&actions) != 0) return false;
  for (int descriptor = 0; descriptor < 3; descriptor++)
    posix_spawn_file_actions_addopen(&actions, descriptor, "/dev/null", O_RDWR, 0);
  bool started = posix_spawnp(&child, arguments[0], &actions, NULL, arguments, environ) == 0;
  posix_spawn_file_actions_destroy(&actions);
  return started;
}

void browser_open(const char *url, browser_page *page) {
  if (!has_screen()) return;
  if (!write_page(url, page)) warn("no private file for the browser: open the URL yourself");
  else if (!start_browser(page->path)) warn("xdg-open cannot be run: open the URL yourself");
  else return;
  browser_forget(page);
}

void browser_forget(browser_page *page) {
  if (page->folder[0] == '\0') return;
  unlink(page->path);
  rmdir(page->folder);
  page->folder[0] = '\0';
}
