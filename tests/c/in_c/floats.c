// Trees of floats in C.
#define NUMBER float
#define TREE raylanes_bvh
#define CALL(name) raylanes_bvh_##name
#define RECORD(name) raylanes_##name
#define KIND "tree"
#define TEST_TREES test_trees_of_floats
#define ANOTHER_LOAD raylanes_bvhd_load
#define ANOTHER_TREE raylanes_bvhd
#include "tree_test.h"
