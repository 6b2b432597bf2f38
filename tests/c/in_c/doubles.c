// Trees of doubles in C.
#define NUMBER double
#define TREE raylanes_bvhd
#define CALL(name) raylanes_bvhd_##name
#define RECORD(name) raylanes_##name##d
#define KIND "tree"
#define TEST_TREES test_trees_of_doubles
#define ANOTHER_LOAD raylanes_bvh_load
#define ANOTHER_TREE raylanes_bvh
#include "tree_test.h"
