// Runs the blocks and examples of the pages one by one; a line "== name" begins what one prints. The argument is the
// folder to which examples write their pictures. Ends with 1 after an exception or a status other than 0.
#include <exception>

#include "page_blocks.hpp"

int main(int count, char** arguments) {
  int status = 0;
  for (const Row& row : rows) {
    std::printf("== %s\n", row.name);
    std::fflush(stdout);
    try {
      if (row.run(count, arguments) != 0) std::printf("WRONG: a status other than 0\n"), status = 1;
    } catch (const std::exception& error) {
      std::printf("WRONG: %s\n", error.what()), status = 1;
    }
  }
  return status;
}
