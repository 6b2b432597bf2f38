// Prints the name of the path in use, or with --required what each path requires of a processor: for the gates that
// run programs on other processors, and look into objects.

#include <cstdio>

#include <raylanes/paths.hpp>

int main(int count, char**) {
  if (count == 1)
    std::puts(raylanes::active_path().name);
  else
    for (const raylanes::Path& path : raylanes::paths())
      std::printf("%s: %s\n", path.name, raylanes::feature_names(path.required).c_str());
}
