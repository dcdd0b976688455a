/* unit/platform_processors.c - the number of processors that Linux's control groups allow, of both versions.
 */
#define _GNU_SOURCE
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include <cmocka.h>

#include "platform/processors.h"

/* A folder that takes the place of the system's root. */
static char root[64];

static int make_root(void **state) {
  (void)state;
  strcpy(root, "/tmp/halflight-processors-XXXXXX");
  return mkdtemp(root) == NULL;
}

static int remove_root(void **state) {
  (void)state;
  char command[128];
  snprintf(command, sizeof command, "rm -r %s", root);
  return system(command);
}

/* Writes a file below the root, and makes the folders above it. */
static void write_file(const char *path, const char *text) {
  char whole[512];
  snprintf(whole, sizeof whole, "%s%s", root, path);
  for (char *slash = whole + strlen(root) + 1; (slash = strchr(slash, '/')) != NULL; slash++) {
    *slash = '\0';
    (void)mkdir(whole, 0777);
    *slash = '/';
  }
  FILE *file = fopen(whole, "w");
  assert_non_null(file);
  fputs(text, file);
  fclose(file);
}

static void expect(double quota) {
  double found = hl_cpu_quota(root);
  if (!(found == quota || fabs(found - quota) < 1e-9)) fail_msg("%g processors, not %g", found, quota);
}

static void test_no_groups(void **state) {
  (void)state;
  expect(INFINITY);
}

static void test_version_2(void **state) {
  (void)state;
  write_file("/proc/self/cgroup", "0::/kubepods/pod7/box\n");
  expect(INFINITY); /* the group's folder is not there */
  write_file("/sys/fs/cgroup/kubepods/pod7/box/cpu.max", "max 100000\n");
  expect(INFINITY);
  write_file("/sys/fs/cgroup/kubepods/pod7/box/cpu.max", "250000 100000\n");
  expect(2.5);
  /* a group above the process's group allows less */
  write_file("/sys/fs/cgroup/kubepods/cpu.max", "80000 50000\n");
  expect(1.6);
  write_file("/sys/fs/cgroup/kubepods/pod7/box/cpu.max", "");
  expect(1.6);
}

/* A process in a container sees its own group as the root of all groups, whatever path it has outside of the
 * container. */
static void test_container(void **state) {
  (void)state;
  write_file("/proc/self/cgroup", "0::/../elsewhere\n");
  write_file("/sys/fs/cgroup/cpu.max", "400000 100000\n");
  expect(4);
}

static void test_version_1(void **state) {
  (void)state;
  write_file("/proc/self/cgroup", "3:cpuset:/a\n2:cpu,cpuacct:/job/9\n1:cpuacct:/b\n");
  write_file("/sys/fs/cgroup/cpu/job/9/cpu.cfs_quota_us", "-1\n");
  write_file("/sys/fs/cgroup/cpu/job/9/cpu.cfs_period_us", "100000\n");
  expect(INFINITY);
  write_file("/sys/fs/cgroup/cpu/job/9/cpu.cfs_quota_us", "150000\n");
  write_file("/sys/fs/cgroup/cpu/job/9/cpu.cfs_period_us", "50000\n");
  expect(3);
}

static void test_nonsense(void **state) {
  (void)state;
  write_file("/proc/self/cgroup", "\n::\nx\n0:/\n4:cpuset:/job\n0::/mad\n");
  write_file("/sys/fs/cgroup/mad/cpu.max", "many 0\n");
  expect(4); /* the limit of the root group */
  write_file("/sys/fs/cgroup/mad/cpu.max", "100 0\n");
  expect(4);
}

static void test_count(void **state) {
  (void)state;
  assert_in_range(hl_cpu_count(), 1, 1 << 16);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_no_groups), cmocka_unit_test(test_version_2), cmocka_unit_test(test_container),
      cmocka_unit_test(test_version_1), cmocka_unit_test(test_nonsense),  cmocka_unit_test(test_count),
  };
  return cmocka_run_group_tests_name("platform_processors", tests, make_root, remove_root);
}
