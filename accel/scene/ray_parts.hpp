// Batches in parts, on one thread or many, once options and views are found good: rays and answers where they lie, or
// copies of those that take part.
#pragma once

#include "../../dispatch/checked.hpp"
#include "../../dispatch/table/kernel_table.hpp"
#include "../batch/in_parallel.hpp"
#include "../batch/ray_source.hpp"
#include "../batch/scratch.hpp"
#include "visits.hpp"

namespace raylanes {

// work(rays, size, answers, counters, numbers) for parts of a batch, of so many at most, from any thread.
template <class Answer, class Work>
void over_ray_parts(const RaySource& rays, std::span<Answer> answers, int threads, TraceCounters* counters,
                    std::size_t most, const Work& work) {
  if (rays.size() == 0) return;
  constexpr std::size_t min_part = 4096, parts_per_thread = 4;
  const std::size_t grain = grain_of(rays.size(), threads, parts_per_thread, min_part, most);
  in_parallel_counted(
      rays.size(), grain, threads, counters, [&](std::size_t begin, std::size_t end, TraceCounters* sum) {
        for (std::size_t size; begin < end; begin += size) {
          size = std::min(most, end - begin);
          if (const Ray* const in = rays.in_place()) {
            work(in + begin, size, answers.data() + begin, sum, detail::RayNumbers{begin});
            continue;
          }
          Scratch scratch(Scratch::bytes_of<Ray>(size) + Scratch::bytes_of<std::size_t>(size) +
                          Scratch::bytes_of<Answer>(size));
          auto* const copies = scratch.take<Ray>(size);
          auto* const numbers = scratch.take<std::size_t>(size);
          auto* const copied = scratch.take<Answer>(size);
          std::size_t count = 0;
          for (std::size_t i = begin; i < begin + size; ++i)
            if (rays.takes_part(i)) copies[count] = rays[i], numbers[count++] = i;
          work(copies, count, copied, sum, detail::RayNumbers{0, numbers});
          for (std::size_t k = 0; k < count; ++k) answers[numbers[k]] = copied[k];
        }
      });
}

inline void require_rays_and_answers(const char* what, const RayView& rays, const void* answers,
                                     std::size_t size) {
  if (rays.first == nullptr && rays.count > 0)
    throw std::invalid_argument(std::string(what) + ": a view of rays points to nothing");
  require_size(what, "answers", size, "rays", rays.count);
  if (answers == nullptr && size > 0)
    throw std::invalid_argument(std::string(what) + ": answers are to go to nowhere");
}

// trace(kernels, batch, answers) for parts of a batch of rays.
template <class Answer, class Trace>
void visit_parts(const char* what, const RayView& rays, std::span<Answer> answers,
                 const VisitOptions& options, const Trace& trace) {
  require_rays_and_answers(what, rays, answers.data(), answers.size());
  require_threads(what, options.threads);
  const KernelTable& kernels = kernels_of(checked_path(options.path));
  if (options.counters != nullptr) require_counters(what, kernels.has_counters());
  constexpr std::size_t most = 32768;  // a test's hits stay near
  over_ray_parts(RaySource{.records = rays, .active = options.active}, answers, options.threads,
                 options.counters, most,
                 [&](const Ray* some, std::size_t size, Answer* to, TraceCounters* counters,
                     const detail::RayNumbers& indices) {
                   BoxedBatch batch{some, size, nullptr, nullptr, nullptr, counters};
                   batch.numbers = indices;
                   trace(kernels, batch, to);
                 });
}

}  // namespace raylanes
