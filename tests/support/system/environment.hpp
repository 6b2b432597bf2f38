// Variables of the environment of this process.
#pragma once

#include <cstdlib>

namespace raylanes {

// Null: there is no such variable any more.
inline void set_environment(const char* name, const char* value) {
#ifdef _WIN32
  _putenv_s(name, value != nullptr ? value : "");
#else
  if (value != nullptr)
    setenv(name, value, 1);
  else
    unsetenv(name);
#endif
}

}  // namespace raylanes
