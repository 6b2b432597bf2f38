// A folder of a test's own, in memory where there is such a place, which goes with what is in it.
#pragma once

#include <filesystem>
#include <fstream>
#include <random>
#include <stdexcept>
#include <string>

namespace raylanes::bench {

class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::random_device random;
    const std::filesystem::path memory = "/dev/shm", place = std::filesystem::is_directory(memory)
                                                                 ? memory
                                                                 : std::filesystem::temp_directory_path();
    for (int i = 0; i < 100 && path_.empty(); ++i)
      if (const auto path = place / ("raylanes_" + std::to_string(random()));
          std::filesystem::create_directory(path))
        path_ = path;
    if (path_.empty()) throw std::runtime_error("no temporary folder");
  }
  ~TemporaryFolder() { std::filesystem::remove_all(path_); }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  // The file of that name, with that content.
  std::filesystem::path write(const std::string& name, const std::string& content) const {
    std::ofstream(path_ / name, std::ios::binary) << content;
    return path_ / name;
  }

 private:
  std::filesystem::path path_;
};

}  // namespace raylanes::bench
