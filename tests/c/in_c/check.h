// Shared by the tests in C: checks that count failures and go on.
#ifndef RAYLANES_TESTS_C_IN_C_CHECK_H
#define RAYLANES_TESTS_C_IN_C_CHECK_H

#include <raylanes/raylanes.h>

#ifdef __cplusplus
extern "C" {
#endif

// Returns how many checks failed, of the first calls of a thread. Files are written whose names begin like that.
int check_c_interface(const char* files);
// Returns the name of a file, until the next call.
const char* file_named(const char* name);

// Prints what does not hold, and where.
void expect(int holds, const char* what, const char* file, int line);
#define EXPECT(condition) expect((condition) != 0, #condition, __FILE__, __LINE__)

// A call that must succeed: prints its message if it does not.
void expect_good(raylanes_status status, const char* call, const char* file, int line);
#define GOOD(call) expect_good((call), #call, __FILE__, __LINE__)

// A call that must be refused, with one line that has a word.
void expect_refused(raylanes_status status, raylanes_status wanted, const char* word, const char* call,
                    const char* file, int line);
#define REFUSED(call, word) \
  expect_refused((call), RAYLANES_INVALID_ARGUMENT, (word), #call, __FILE__, __LINE__)
#define FAILS(call, status, word) expect_refused((call), (status), (word), #call, __FILE__, __LINE__)

void test_trees_of_floats(void);
void test_trees_of_doubles(void);
void test_scenes(void);
void test_scenes_of_doubles(void);
void test_roots(void);
void test_paths(void);
void test_options(void);

#ifdef __cplusplus
}
#endif
#endif
