// The lifetimes of arguments that views are made of.
#pragma once

#include <ranges>

// Marks a parameter: clang warns (-Wdangling) if what is made of it outlives the temporary that it is bound to.
#if defined(__has_cpp_attribute)
#if __has_cpp_attribute(clang::lifetimebound)
#define RAYLANES_LIFETIMEBOUND [[clang::lifetimebound]]
#endif
#endif
#ifndef RAYLANES_LIFETIMEBOUND
#define RAYLANES_LIFETIMEBOUND
#endif

namespace raylanes::detail {

// Whether an argument R&& is a temporary range that owns its elements: a vector is one, a span and an lvalue are not.
template <class R>
concept OwningTemporary = std::ranges::range<R> && !std::ranges::borrowed_range<R>;

}  // namespace raylanes::detail
