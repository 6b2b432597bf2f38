// The shares that a call tells a Progress, and whether it does the same as without.
#pragma once

#include <thread>

#include <raylanes/progress.hpp>

#include "testing.hpp"

namespace raylanes::testing {

// The shares that a call told, by a Progress that must be called on the thread that made this.
struct Reports {
  std::vector<double> shares;
  std::thread::id caller = std::this_thread::get_id();
  Progress progress = [this](double share) {
    EXPECT_EQ(std::this_thread::get_id(), caller);
    shares.push_back(share);
  };

  void expect_whole() const {
    ASSERT_GE(shares.size(), 2u);
    EXPECT_EQ(shares.front(), 0.0);
    EXPECT_EQ(shares.back(), 1.0);
    EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
  }
};

// call(const Progress*) returns bytes of results, the same with reports; what a report throws passes through, and the
// next call is as before.
template <class Call>
void expect_reported(const std::string& name, const Call& call) {
  SCOPED_TRACE(name);
  const auto expected = call(nullptr);
  Reports reports;
  EXPECT_TRUE(call(&reports.progress) == expected);
  reports.expect_whole();
  for (const double end : {0.0, 1.0}) {
    const Progress gives_up = [=](double share) {
      if (share >= end) throw std::runtime_error("enough");
    };
    EXPECT_THROW(call(&gives_up), std::runtime_error);
  }
  const Progress nobody;
  EXPECT_TRUE(call(&nobody) == expected);
}

// The bytes of elements.
template <class Items>
std::string bytes_of(const Items& items) {
  return {reinterpret_cast<const char*>(items.data()), items.size() * sizeof(*items.data())};
}
// The same check where call(results, progress) writes so many results.
template <class Result, class Call>
void expect_reported(const std::string& name, std::size_t n, const Call& call) {
  expect_reported(name, [&](const Progress* progress) {
    std::vector<Result> results(n);
    call(results, progress);
    return bytes_of(results);
  });
}

}  // namespace raylanes::testing
