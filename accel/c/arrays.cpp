// The C functions of ISA paths and of roots of arrays.
#include <raylanes/roots.hpp>

#include "call.hpp"

namespace raylanes::c {
namespace {

template <class T, class Root>
raylanes_status roots(const T* x, T* y, std::size_t count, std::int32_t accuracy, const char* path,
                      const Root& root) {
  return status_of([&] {
    root(span_of<const T>("x", x, count), span_of<T>("y", y, count),
         enumerator_of<Accuracy>("accuracy", accuracy, accuracies.size()), path_of(path));
  });
}

template <class T>
raylanes_status write_accuracy(double relative_error, std::int32_t* accuracy) {
  return status_of([&] {
    require_pointer("accuracy", accuracy);
    *accuracy = static_cast<std::int32_t>(accuracy_within<T>(relative_error));
  });
}

}  // namespace

extern "C" {

std::size_t raylanes_path_count() {
  return paths().size();
}

raylanes_status raylanes_path_at(std::size_t index, const char** name, std::int32_t* is_supported) {
  return status_of([&] {
    require_pointer("name", name);
    require_pointer("is_supported", is_supported);
    if (index >= paths().size()) refuse_index("raylanes_path_at", "path", index, paths().size());
    *name = paths()[index].name;
    *is_supported = supported(paths()[index]);
  });
}

raylanes_status raylanes_active_path(const char** name) {
  return status_of([&] {
    require_pointer("name", name);
    *name = active_path().name;
  });
}

raylanes_status raylanes_force_path(const char* name) {
  return status_of([&] {
    if (name == nullptr)
      unforce_path();
    else
      force_path(name);
  });
}

raylanes_status raylanes_accuracy_within(double relative_error, std::int32_t* accuracy) {
  return write_accuracy<float>(relative_error, accuracy);
}

raylanes_status raylanes_accuracy_withind(double relative_error, std::int32_t* accuracy) {
  return write_accuracy<double>(relative_error, accuracy);
}

raylanes_status raylanes_sqrt(const float* x, float* y, std::size_t count, std::int32_t accuracy,
                              const char* path) {
  return roots(x, y, count, accuracy, path, [](auto... arguments) { sqrt(arguments...); });
}

raylanes_status raylanes_sqrtd(const double* x, double* y, std::size_t count, std::int32_t accuracy,
                               const char* path) {
  return roots(x, y, count, accuracy, path, [](auto... arguments) { sqrt(arguments...); });
}

raylanes_status raylanes_rsqrt(const float* x, float* y, std::size_t count, std::int32_t accuracy,
                               const char* path) {
  return roots(x, y, count, accuracy, path, [](auto... arguments) { rsqrt(arguments...); });
}

raylanes_status raylanes_rsqrtd(const double* x, double* y, std::size_t count, std::int32_t accuracy,
                                const char* path) {
  return roots(x, y, count, accuracy, path, [](auto... arguments) { rsqrt(arguments...); });
}

raylanes_status raylanes_reciprocal(const float* x, float* y, std::size_t count, std::int32_t accuracy,
                                    const char* path) {
  return roots(x, y, count, accuracy, path, [](auto... arguments) { reciprocal(arguments...); });
}

raylanes_status raylanes_reciprocald(const double* x, double* y, std::size_t count, std::int32_t accuracy,
                                     const char* path) {
  return roots(x, y, count, accuracy, path, [](auto... arguments) { reciprocal(arguments...); });
}

}  // extern "C"
}  // namespace raylanes::c
