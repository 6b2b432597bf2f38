// Compiled once for all test programs: a third of their time went to these. No file counts on it.
#include <gmpxx.h>

#include <filesystem>
#include <fstream>
#include <random>
#include <thread>

#include <raylanes/bvh.hpp>
#include <raylanes/kdtree.hpp>

#include "../support/testing.hpp"
