// Compiled once for all test programs: a third of their time went to these. No file counts on it.
#include <gmpxx.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>
#include <set>
#include <span>
#include <sstream>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <raylanes/bvh.hpp>
#include <raylanes/kdtree.hpp>
