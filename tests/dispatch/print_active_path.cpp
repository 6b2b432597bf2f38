// Prints the name of the path in use, for the gates that run programs on other processors.

#include <cstdio>

#include <raylanes/paths.hpp>

int main() {
  std::puts(raylanes::active_path().name);
}
