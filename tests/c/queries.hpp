// Queries of many elements by the functions of C and by the methods of the classes, in pairs, to compare what both
// write.
#pragma once

#include <tuple>

#include <raylanes/numbers.hpp>
#include <raylanes/stretches.hpp>

#include "calls.hpp"

namespace raylanes::testing {

// of_c takes what C does, and of_cpp writes the same results. They have a stride in C if `has_stride`.
template <class AnyResult, class AnyOptions, bool has_filter, class OfC, class OfCpp>
struct QueryOfBoth {
  using Result = AnyResult;
  using Options = AnyOptions;
  static constexpr bool takes_filter = has_filter;
  const char* name;
  OfC of_c;
  OfCpp of_cpp;
  bool has_stride = false;
};
template <class Result, class Options, bool takes_filter = false, class OfC, class OfCpp>
QueryOfBoth<Result, Options, takes_filter, OfC, OfCpp> query(const char* name, OfC of_c, OfCpp of_cpp,
                                                             bool has_stride = false) {
  return {name, of_c, of_cpp, has_stride};
}

// A function of C whose results have no stride, called as if they had one.
template <class Tree, class Result, class Options>
auto dense(raylanes_status (*call)(const Tree*, const void*, std::size_t, std::size_t, Result*,
                                   const Options*)) {
  return [call](const Tree* tree, const void* from, std::size_t n, std::size_t stride, void* to, std::size_t,
                const Options* by) { return call(tree, from, n, stride, static_cast<Result*>(to), by); };
}

// visit(query) for each.
template <class Queries, class Visit>
void each_query(const Queries& queries, const Visit& visit) {
  std::apply([&](const auto&... query) { (visit(query), ...); }, queries);
}
template <class Queries, class Visit>
void some_query(const Queries& queries, std::size_t number, const Visit& visit) {
  each_query(queries, [&](const auto& query) {
    if (number-- == 0) visit(query);
  });
}

#define RAYLANES_METHOD(name) [](const auto& tree, auto&&... arguments) { return tree.name(arguments...); }
template <class Kind>
struct QueriesOf {
  using C = CallsOf<Kind>;
  using Number = typename C::Number;
  using Hit = HitOfKind<Kind>;
  using Trace = typename C::Trace;

  static auto of_rays() {
    return std::tuple(
        query<Hit, Trace, true>("closest", C::closest, RAYLANES_METHOD(closest), true),
        query<Hit, Trace>("crossing", C::closest_crossing, RAYLANES_METHOD(closest_crossing), true),
        query<std::uint8_t, Trace, true>("occluded", dense(C::occluded), RAYLANES_METHOD(occluded)),
        query<CrossingCount, ListOptions>("counts", dense(C::count_crossings),
                                          RAYLANES_METHOD(count_crossings)));
  }
  static auto of_points() {
    return std::tuple(query<Location, LocateOptions>("locate", dense(C::locate), RAYLANES_METHOD(locate)),
                      query<Number, WindingOptions>("windings", dense(C::winding_numbers),
                                                    RAYLANES_METHOD(winding_numbers)),
                      query<Number, typename C::Distances>("distances", dense(C::signed_distances),
                                                           RAYLANES_METHOD(signed_distances)),
                      query<typename C::ClosestPoint, typename C::Closest>(
                          "closest_points", dense(C::closest_points), RAYLANES_METHOD(closest_points)));
  }
  // Lists are made, not written.
  static auto of_lists() {
    return std::tuple(query<void, ListOptions>("all_hits", C::all_hits, RAYLANES_METHOD(all_hits)),
                      query<void, ListOptions>("crossings", C::crossings, RAYLANES_METHOD(crossings)),
                      query<void, ListOptions>("stretches", C::stretches, [](auto&&... arguments) {
                        return stretches(arguments...);
                      }));
  }
};
#undef RAYLANES_METHOD

}  // namespace raylanes::testing
