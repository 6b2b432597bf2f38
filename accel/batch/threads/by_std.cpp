// With -Dthreads=std. Threads live as long as the call that started them: nothing is
// left to a process that forks, ends or unloads the library.
#include <condition_variable>
#include <exception>
#include <system_error>
#include <thread>

#include "../in_parallel.hpp"

namespace raylanes {
namespace {

int core_count() {
  static const int count = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  return count;
}

// Work whose parts threads take one after the other.
class Job {
 public:
  Job(std::size_t n, std::size_t grain, const std::function<void(std::size_t, std::size_t)>& work)
      : n_(n), grain_(std::max(grain, std::size_t{1})), work_(work) {}

  bool has_parts() const { return next_ < n_; }
  void take_parts() noexcept {
    std::size_t begin = next_;
    while (begin < n_) {
      const std::size_t end = begin + std::min(grain_, n_ - begin);
      if (next_.compare_exchange_weak(begin, end)) do_part(begin, end), begin = next_;
    }
  }
  // Once no thread takes parts.
  void rethrow() const {
    if (error_ != nullptr) std::rethrow_exception(error_);
  }

  int helpers = 0;  // threads of the team that take parts; guarded by the team's mutex

 private:
  void do_part(std::size_t begin, std::size_t end) noexcept {
    try {
      work_(begin, end);
    } catch (...) {
      if (!failed_.exchange(true)) error_ = std::current_exception();
      next_ = n_;  // no part begins any more
    }
  }

  const std::size_t n_, grain_;
  const std::function<void(std::size_t, std::size_t)>& work_;
  std::atomic<std::size_t> next_{0};
  std::atomic<bool> failed_{false};
  std::exception_ptr error_;
};

// Some threads and the one that made them. A thread that gave out a job takes parts of it, then waits for its helpers
// alone: helpers only wait for jobs that they gave out themselves, so that nested calls end.
class Team {
 public:
  explicit Team(int size) : size_(size) {
    try {
      while (static_cast<int>(helpers_.size()) + 1 < size) helpers_.emplace_back([this] { help(); });
    } catch (const std::system_error&) {  // those that are there suffice
    } catch (...) {
      end();
      throw;
    }
  }
  ~Team() { end(); }
  Team(const Team&) = delete;
  Team& operator=(const Team&) = delete;

  int size() const { return size_; }
  void run(Job& job) {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      jobs_.push_back(&job);
    }
    changed_.notify_all();
    job.take_parts();
    std::unique_lock<std::mutex> lock(mutex_);
    std::erase(jobs_, &job);
    changed_.wait(lock, [&] { return job.helpers == 0; });
  }

 private:
  void help();
  // The latest job, which others wait for.
  Job* job_with_parts() const {
    const auto found =
        std::find_if(jobs_.rbegin(), jobs_.rend(), [](const Job* job) { return job->has_parts(); });
    return found == jobs_.rend() ? nullptr : *found;
  }
  void end() {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      ended_ = true;
    }
    changed_.notify_all();
    for (std::thread& helper : helpers_) helper.join();
  }

  const int size_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<Job*> jobs_;
  bool ended_ = false;
  std::vector<std::thread> helpers_;
};

// That of the job whose part this thread is in.
thread_local Team* current_team = nullptr;

class WithinTeam {
 public:
  explicit WithinTeam(Team& team) { current_team = &team; }
  ~WithinTeam() { current_team = before_; }
  WithinTeam(const WithinTeam&) = delete;
  WithinTeam& operator=(const WithinTeam&) = delete;

 private:
  Team* const before_ = current_team;
};

void Team::help() {
  const WithinTeam within(*this);
  std::unique_lock<std::mutex> lock(mutex_);
  for (;;) {
    Job* job = nullptr;
    changed_.wait(lock, [&] { return (job = job_with_parts()) != nullptr || ended_; });
    if (job == nullptr) return;
    ++job->helpers;
    lock.unlock();
    job->take_parts();
    lock.lock();
    if (--job->helpers == 0) changed_.notify_all();
  }
}

template <class Work>
void with_team(int threads, const Work& work) {
  Team team(thread_count(threads));
  const WithinTeam within(team);
  work(team);
}

}  // namespace

int thread_count(int threads) {
  if (threads == 0) return current_team != nullptr ? current_team->size() : core_count();
  return std::min(threads, core_count());
}

void spread(std::size_t n, std::size_t grain, int threads,
            const std::function<void(std::size_t, std::size_t)>& work) {
  Job job(n, grain, work);
  if (threads == 0 && current_team != nullptr)
    current_team->run(job);
  else
    with_team(threads, [&](Team& team) { team.run(job); });
  job.rethrow();
}

void in_arena(int threads, const std::function<void()>& work) {
  with_team(threads, [&](Team&) { work(); });
}

// Threads that wait take up nothing in any case.
void isolated(const std::function<void()>& work) {
  work();
}

}  // namespace raylanes
