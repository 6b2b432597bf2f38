#include "valid_parts.hpp"

#include <stdexcept>
#include <string>

namespace raylanes {

void refuse(const char* what, std::size_t number, const char* why) {
  throw std::runtime_error(std::string("tree: ") + what + ' ' + std::to_string(number) + ' ' + why);
}

}  // namespace raylanes
