// The C interface in C, without C++: each function and each refusal, with results that are known.
#include "check.h"

int main(void) {
  return check_c_interface("c_interface_") == 0 ? 0 : 1;
}
