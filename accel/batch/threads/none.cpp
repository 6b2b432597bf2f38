// With -Dthreads=none: the calling thread does all work, without oneTBB.
#include "../in_parallel.hpp"

namespace raylanes {

int thread_count(int) {
  return 1;
}

void spread(std::size_t n, std::size_t grain, int,
            const std::function<void(std::size_t, std::size_t)>& work) {
  grain = std::max(grain, std::size_t{1});
  for (std::size_t begin = 0, end; begin < n; begin = end) {
    end = begin + std::min(grain, n - begin);
    work(begin, end);
  }
}

void in_arena(int, const std::function<void()>& work) {
  work();
}

void isolated(const std::function<void()>& work) {
  work();
}

}  // namespace raylanes
