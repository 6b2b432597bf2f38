// A fault of each kind that a sanitizer must end the program for: without one it returns 0.
//
// usage: sanitizer_fault address|undefined|thread
#include <memory>
#include <string_view>
#include <thread>

#include <climits>

namespace {

volatile int one = 1;

int fault(std::string_view kind) {
  int sum = 0;
  if (kind == "undefined") sum = INT_MAX + one;
  if (kind == "address") sum = std::make_unique<int[]>(1)[static_cast<unsigned>(one)];
  if (kind == "thread") {
    std::thread other([&] { ++sum; });
    ++sum;
    other.join();
  }
  return sum;
}

}  // namespace

int main(int count, char** arguments) {
  one = fault(count > 1 ? arguments[1] : "");
}
