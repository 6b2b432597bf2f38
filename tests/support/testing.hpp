// GoogleTest, and what most tests use of the standard library; compiled beforehand by ../pch/tests.hpp.
#pragma once

#include <gtest/gtest.h>

#include "../../bench/support/std.hpp"
