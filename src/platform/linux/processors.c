/* platform/linux/processors.c - finds the number of processors that this process may use. The number is the
 * number of processors on which the process may run, limited by the processor time that its control groups
 * (of containers and batch jobs) allow. */
#define _GNU_SOURCE /* sched_getaffinity */
#include "platform/processors.h"

#include <limits.h>
#include <math.h>
#include <sched.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "text/plain.h"

/* The greatest number of processors for which an affinity mask is read. */
enum { MOST_PROCESSORS = 1 << 16 };

static int count_of_affinity(void) {
  for (int most = 1024; most <= MOST_PROCESSORS; most *= 4) {
    cpu_set_t *set = CPU_ALLOC(most);
    size_t bytes = CPU_ALLOC_SIZE(most);
    int count = set != NULL && sched_getaffinity(0, bytes, set) == 0 ? CPU_COUNT_S(bytes, set) : 0;
    CPU_FREE(set);
    if (count > 0) return count;
  }
  return 1;
}

/* ---- control groups ---- */

enum { PATH_BYTES = 4096 };

static bool take_number(const char **text, double *number) {
  char *end;
  double read = hl_plain_number(*text, &end);
  if (end == *text) return false;
  *number = read;
  *text = end;
  return true;
}

/* Reads the first two numbers of a file; "max" counts as -1. Returns how many numbers were read. */
static int read_numbers(const char *folder, const char *name, double number[2]) {
  char path[PATH_BYTES + 64], text[64] = "";
  snprintf(path, sizeof path, "%s/%s", folder, name);
  FILE *file = fopen(path, "re");
  if (file == NULL) return 0;
  char *line = fgets(text, sizeof text, file);
  fclose(file);
  if (line == NULL) return 0;
  const char *rest = text;
  if (strncmp(text, "max", 3) == 0) {
    number[0] = -1;
    rest = text + 3;
    return take_number(&rest, &number[1]) ? 2 : 1;
  }
  if (!take_number(&rest, &number[0])) return 0;
  return take_number(&rest, &number[1]) ? 2 : 1;
}

/* The processor time that one control group may use, as a number of processors; infinite if the group has no
 * limit. */
static double quota_of_group(const char *folder, bool unified) {
  double of_quota[2] = {-1, 100000}, of_period[2];
  if (unified) {
    if (read_numbers(folder, "cpu.max", of_quota) < 1) return INFINITY;
  } else {
    if (read_numbers(folder, "cpu.cfs_quota_us", of_quota) < 1) return INFINITY;
    if (read_numbers(folder, "cpu.cfs_period_us", of_period) >= 1) of_quota[1] = of_period[0];
  }
  return of_quota[0] > 0 && of_quota[1] > 0 ? of_quota[0] / of_quota[1] : INFINITY;
}

/* The least quota of processor time of a control group and of all groups above it. path: the group's folder,
 * "/...", below the folder of the hierarchy. The folder may be missing: in a container, the system may report
 * a path that exists only outside of the container. The process's own group is then the top of the
 * container's hierarchy. */
static double quota_of_path(const char *hierarchy, const char *path, bool unified) {
  char folder[PATH_BYTES];
  int length = snprintf(folder, sizeof folder, "%s%s", hierarchy, path);
  if (length < 0 || (size_t)length >= sizeof folder) return INFINITY;
  size_t top = strlen(hierarchy);
  double least = INFINITY;
  for (;;) {
    least = fmin(least, quota_of_group(folder, unified));
    char *slash = strrchr(folder + top, '/');
    if (slash == NULL) return least;
    *slash = '\0';
  }
}

/* Returns whether a list of controllers, such as "cpu,cpuacct", contains "cpu", the controller of processor
 * time. */
static bool has_cpu(const char *controllers) {
  for (const char *at = controllers; at != NULL; at = strchr(at, ',')) {
    at += *at == ',';
    if (strncmp(at, "cpu", 3) == 0 && (at[3] == ',' || at[3] == '\0')) return true;
  }
  return false;
}

double hl_cpu_quota(const char *root) {
  char path[PATH_BYTES], line[PATH_BYTES], hierarchy[PATH_BYTES];
  double least = INFINITY;
  snprintf(path, sizeof path, "%s/proc/self/cgroup", root);
  FILE *file = fopen(path, "re");
  while (file != NULL && fgets(line, sizeof line, file) != NULL) {
    /* a line has the form number:controllers:path */
    line[strcspn(line, "\n")] = '\0';
    char *controllers = strchr(line, ':'), *group = controllers != NULL ? strchr(controllers + 1, ':') : NULL;
    if (group == NULL) continue;
    *group++ = '\0';
    controllers++;
    bool unified = *controllers == '\0';
    if (!unified && !has_cpu(controllers)) continue;
    snprintf(hierarchy, sizeof hierarchy, "%s/sys/fs/cgroup%s", root, unified ? "" : "/cpu");
    least = fmin(least, quota_of_path(hierarchy, group, unified));
  }
  if (file != NULL) fclose(file);
  return least;
}

int hl_cpu_count(void) {
  int count = count_of_affinity();
  double quota = ceil(hl_cpu_quota(""));
  return quota < count ? (int)fmax(quota, 1) : count;
}
