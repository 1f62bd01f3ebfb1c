// SPDX-License-Identifier: GPL-3.0-or-later
// Preloaded by fault_test.py: lets calls on unfinished outputs fail. FAULT_AT=K FAULT_ERRNO=E: the K-th call of mkostemp,
// write, fsync or rename fails with E. FAULT_WRITES=short: writes take 100 bytes at most, and every other one is interrupted.
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static int calls;

static int fails(void) {
  const char* at = getenv("FAULT_AT");
  if (!at || ++calls != atoi(at)) return 0;
  errno = atoi(getenv("FAULT_ERRNO"));
  return 1;
}

static int is_output(int descriptor) {
  char link[64], name[4400];
  snprintf(link, sizeof link, "/proc/self/fd/%d", descriptor);
  const ssize_t n = readlink(link, name, sizeof name - 1);
  if (n < 0) return 0;
  name[n] = 0;
  return strstr(name, ".ramify.part") != NULL;
}

ssize_t write(int descriptor, const void* bytes, size_t count) {
  ssize_t (*real)(int, const void*, size_t) = dlsym(RTLD_NEXT, "write");
  if (is_output(descriptor)) {
    static int turn;
    if (fails()) return -1;
    if (getenv("FAULT_WRITES")) {
      if (++turn % 2) return errno = EINTR, -1;
      if (count > 100) count = 100;
    }
  }
  return real(descriptor, bytes, count);
}

int fsync(int descriptor) {
  int (*real)(int) = dlsym(RTLD_NEXT, "fsync");
  return is_output(descriptor) && fails() ? -1 : real(descriptor);
}

int rename(const char* from, const char* to) {
  int (*real)(const char*, const char*) = dlsym(RTLD_NEXT, "rename");
  return fails() ? -1 : real(from, to);
}

int mkostemp(char* name, int flags) {
  int (*real)(char*, int) = dlsym(RTLD_NEXT, "mkostemp");
  return fails() ? -1 : real(name, flags);
}
