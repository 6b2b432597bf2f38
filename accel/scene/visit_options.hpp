// What queries of trees over boxes check before anything is traced.
#pragma once

#include "../../dispatch/checked.hpp"
#include "../../dispatch/table.hpp"
#include "ray_parts.hpp"
#include "visits.hpp"

namespace raylanes {

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
  const KernelTable& kernels = checked_path(options.path).kernels;
  if (options.counters != nullptr) require_counters(what, kernels.has_counters());
  over_ray_parts(RaySource{.records = rays, .active = options.active}, answers, options.threads,
                 options.counters,
                 [&](const Ray* some, std::size_t size, Answer* to, TraceCounters* counters) {
                   trace(kernels, BoxedBatch{some, size, nullptr, nullptr, nullptr, counters}, to);
                 });
}

}  // namespace raylanes
