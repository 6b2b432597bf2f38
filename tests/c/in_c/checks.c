// Counts of the checks in C, and all of them in turn.
#include <stdio.h>
#include <string.h>

#include "check.h"

static int failures = 0, checks = 0;
static const char* prefix = "";

void expect(int holds, const char* what, const char* file, int line) {
  ++checks;
  if (holds) return;
  ++failures;
  printf("FAILED: %s:%d: %s\n", file, line, what);
}

void expect_good(raylanes_status status, const char* call, const char* file, int line) {
  expect(status == RAYLANES_OK, call, file, line);
  if (status != RAYLANES_OK) printf("  status %d: %s\n", (int)status, raylanes_last_message());
}

void expect_refused(raylanes_status status, raylanes_status wanted, const char* word, const char* call,
                    const char* file, int line) {
  const char* message = raylanes_last_message();
  const int is_told = status == wanted && strstr(message, word) != NULL && strchr(message, '\n') == NULL;
  expect(is_told, call, file, line);
  if (!is_told) printf("  status %d, not %d with \"%s\": %s\n", (int)status, (int)wanted, word, message);
}

const char* file_named(const char* name) {
  static char whole[256];
  snprintf(whole, sizeof whole, "%s%s", prefix, name);
  return whole;
}

int check_c_interface(const char* files) {
  failures = checks = 0;
  prefix = files;
  EXPECT(strcmp(raylanes_last_message(), "") == 0);
  EXPECT(strncmp(raylanes_version(), "0.", 2) == 0);
  test_paths();
  test_options();
  test_roots();
  test_trees_of_floats();
  test_trees_of_doubles();
  test_scenes();
  test_scenes_of_doubles();
  printf("%d checks, %d failed\n", checks, failures);
  return failures;
}
