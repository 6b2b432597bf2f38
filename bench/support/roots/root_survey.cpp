#include "root_survey.hpp"

#include <atomic>
#include <mutex>

#include "../../../accel/batch/in_parallel.hpp"
#include "../../../dispatch/hardest_roots.hpp"
#include "../../../dispatch/table/kernel_table.hpp"
#include "../../../dispatch/table/roots.hpp"
#include "root_judge.hpp"

namespace raylanes {
namespace bench {
namespace {

constexpr std::uint32_t block_count = 1u << 19;

void add(RootAccuracy& sum, const RootAccuracy& a) {
  if (a.max_ulp > sum.max_ulp || (a.max_ulp == sum.max_ulp && a.max_ulp_at < sum.max_ulp_at)) {
    sum.max_ulp = a.max_ulp;
    sum.max_ulp_at = a.max_ulp_at;
  }
  sum.least_relative_error = std::min(sum.least_relative_error, a.least_relative_error);
  sum.greatest_relative_error = std::max(sum.greatest_relative_error, a.greatest_relative_error);
  sum.sum_of_squares += a.sum_of_squares;
  sum.inputs += a.inputs;
  sum.correctly_rounded += a.correctly_rounded;
  sum.positive_inputs += a.positive_inputs;
  sum.positive_correctly_rounded += a.positive_correctly_rounded;
  sum.normal_inputs += a.normal_inputs;
  sum.normal_correctly_rounded += a.normal_correctly_rounded;
  sum.wrong_specials += a.wrong_specials;
  sum.monotony_violations += a.monotony_violations;
  sum.hash += a.hash;
}

// The state of one thread.
class Worker {
 public:
  explicit Worker(std::size_t rows) : sums_(rows) {}

  void judge(std::span<const RootRow> rows, std::uint32_t number) {
    block_.set(number);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      if (i == 0 || rows[i].function != rows[i - 1].function) {
        block_.expect(rows[i].function);
        made_ = 0;
      }
      add_judgement(sums_[i], judged(rows[i]));
    }
  }
  const std::vector<RootAccuracy>& sums() const { return sums_; }

 private:
  struct Judged {
    std::vector<float> output = std::vector<float>(root_block_size);
    RootAccuracy accuracy;
    bool located = false;  // max_ulp_at is known
  };

  // Most rows repeat the bits of one of the last, which is seen at the first cache line or not at all.
  Judged& judged(const RootRow& row) {
    Judged& now = recent_[made_ % recent_.size()];
    row.kernel()(block_.input(), now.output.data(), root_block_size);
    for (std::size_t age = 1; age < recent_.size() && age <= made_; ++age) {
      Judged& former = recent_[(made_ - age) % recent_.size()];
      if (std::memcmp(former.output.data(), now.output.data(), root_block_size * sizeof(float)) == 0)
        return former;
    }
    now.accuracy = block_.judge(now.output.data());
    now.located = false;
    ++made_;
    return now;
  }

  void add_judgement(RootAccuracy& sum, Judged& judged) {
    RootAccuracy& a = judged.accuracy;
    if (a.max_ulp > 0 && a.max_ulp >= sum.max_ulp && !judged.located) {
      a.max_ulp_at = block_.where(judged.output.data(), a.max_ulp);
      judged.located = true;
    }
    add(sum, a);
  }

  RootBlock block_;
  // Different outputs for this block under this function: as many as stay in the second-level cache.
  std::array<Judged, 7> recent_;
  std::size_t made_ = 0;
  std::vector<RootAccuracy> sums_;
};

std::vector<std::uint32_t> chosen_blocks(std::uint32_t stride) {
  constexpr std::uint32_t per_binade = 0x00800000u / root_block_size,
                          infinite = 0x7f800000u / root_block_size;
  std::vector<std::uint32_t> numbers;
  for (std::uint32_t n = 0; n < block_count; ++n) {
    const std::uint32_t magnitude = n % (block_count / 2);
    const bool edge = magnitude == 0 || magnitude == per_binade || magnitude + 1 == infinite ||
                      magnitude == infinite || n + 1 == block_count;
    // One of each group of `stride`, at varying places: a fixed one would meet the same significands again.
    const std::uint32_t group = n / stride;
    if (edge || n % stride == group * 2654435761u % 4294967291u % stride) numbers.push_back(n);
  }
  return numbers;
}

// Those that no thread uses now.
class Workers {
 public:
  explicit Workers(std::size_t rows) : rows_(rows) {}

  std::unique_ptr<Worker> take() {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (idle_.empty()) return std::make_unique<Worker>(rows_);
    std::unique_ptr<Worker> worker = std::move(idle_.back());
    idle_.pop_back();
    return worker;
  }
  void put(std::unique_ptr<Worker> worker) {
    const std::lock_guard<std::mutex> lock(mutex_);
    idle_.push_back(std::move(worker));
  }
  const std::vector<std::unique_ptr<Worker>>& all() const { return idle_; }

 private:
  const std::size_t rows_;
  std::mutex mutex_;
  std::vector<std::unique_ptr<Worker>> idle_;
};

}  // namespace

namespace {

// f(rows, methods) of a function: its rows in the kernel table, its methods.
template <class F>
auto with_rows(RootFunction function, const Path& path, F f) {
  const RootKernels& roots = kernels_of(path).roots;
  if (function == RootFunction::sqrt) {
    auto rows = roots.sqrt;  // as this machine takes them
    for (std::size_t m = 0; m < sqrt_methods.size(); ++m)
      rows.by[m] = fastest_sqrt(roots, static_cast<SqrtMethod>(m), machine_splits_512_bits());
    for (const AccuracyInfo& info : accuracies)
      rows.within[static_cast<std::size_t>(info.accuracy)] =
          serving_sqrt(roots, info.accuracy, machine_splits_512_bits());
    return f(rows, sqrt_methods);
  }
  if (function == RootFunction::rsqrt) return f(roots.rsqrt, rsqrt_methods);
  return f(roots.reciprocal, reciprocal_methods);
}

}  // namespace

std::size_t method_count(RootFunction function) {
  return with_rows(function, paths().front(),
                   [](const auto&, const auto& methods) { return methods.size(); });
}

const RootPromise& promise_of(RootFunction function, std::size_t method) {
  return *with_rows(function, paths().front(),
                    [&](const auto&, const auto& methods) { return &methods[method].promise; });
}

std::size_t method_within(RootFunction function, Accuracy accuracy, const Path& path) {
  return with_rows(function, path, [&](const auto& rows, const auto&) {
    return static_cast<std::size_t>(rows.within[static_cast<std::size_t>(accuracy)]);
  });
}

ArrayFunction<float> RootRow::kernel() const {
  return with_rows(function, *path, [&](const auto& rows, const auto&) { return rows.by[method]; });
}

double RootAccuracy::max_relative_error() const {
  return std::max(-least_relative_error, greatest_relative_error);
}

double RootAccuracy::root_mean_square() const {
  return normal_inputs == 0 ? 0.0 : std::sqrt(sum_of_squares / static_cast<double>(normal_inputs));
}

std::vector<RootAccuracy> survey_roots(std::span<const RootRow> rows, std::uint32_t stride,
                                       const Progress& progress) {
  const std::vector<std::uint32_t> numbers = chosen_blocks(stride);
  Workers workers(rows.size());
  std::atomic<std::size_t> done = 0;
  in_parallel(numbers.size(), 1, 0, [&](std::size_t begin, std::size_t end) {
    std::unique_ptr<Worker> worker = workers.take();
    for (std::size_t i = begin; i < end; ++i) {
      worker->judge(rows, numbers[i]);
      if (progress) progress(static_cast<double>(++done) / static_cast<double>(numbers.size()));
    }
    workers.put(std::move(worker));
  });
  std::vector<RootAccuracy> sums(rows.size());
  for (const std::unique_ptr<Worker>& worker : workers.all())
    for (std::size_t i = 0; i < sums.size(); ++i) add(sums[i], worker->sums()[i]);
  return sums;
}

std::vector<RootRow> all_root_rows(std::span<const Path* const> paths) {
  std::vector<RootRow> rows;
  for (const RootFunction function : {RootFunction::sqrt, RootFunction::rsqrt, RootFunction::reciprocal})
    for (std::size_t m = 0; m < method_count(function); ++m)
      for (const Path* path : paths) rows.push_back({function, m, path});
  return rows;
}

}  // namespace bench
}  // namespace raylanes
