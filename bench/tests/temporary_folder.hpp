// A folder of a test's own, in memory where there is such a place, which goes with what is in it.
#pragma once

#include <stdlib.h>

#include <filesystem>
#include <fstream>

#include "../../tests/support/testing.hpp"

namespace raylanes::bench {

namespace fs = std::filesystem;

class TemporaryFolder {
 public:
  TemporaryFolder() {
    const fs::path memory = "/dev/shm", place = fs::is_directory(memory) ? memory : fs::temp_directory_path();
    std::string name = place / "raylanes_XXXXXX";
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
    path_ = name;
  }
  ~TemporaryFolder() { fs::remove_all(path_); }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  fs::path operator/(const std::string& name) const { return path_ / name; }
  // The file of that name, with that content.
  fs::path write(const std::string& name, const std::string& content) const {
    std::ofstream(path_ / name, std::ios::binary) << content;
    return path_ / name;
  }

 private:
  fs::path path_;
};

}  // namespace raylanes::bench
