// Judges what a root gives for a block of neighbouring floats: errors, order, and a hash of all bits.
#pragma once

#include "root_survey.hpp"

namespace raylanes::bench {

inline constexpr std::uint32_t root_block_size = 1u << 13;  // what is kept of one fits the second-level cache

// The inputs of one block and what is right for them under one function. Made once per thread.
class RootBlock {
 public:
  // The `number`-th block of all floats in the order of their bits; `expect` must follow.
  void set(std::uint32_t number);
  // Computes the correct results of these inputs under `function`.
  void expect(RootFunction function);

  const float* input() const { return input_.data(); }
  std::uint32_t first() const { return first_; }
  // Everything but max_ulp_at, which takes another pass and is seldom wanted. NaN for a normal number is
  // infinitely wrong.
  RootAccuracy judge(const float* output) const;
  // The least input whose error is `ulp`, a maximum that `judge` gave.
  std::uint32_t where(const float* output, double ulp) const;

 private:
  void count_positive(RootAccuracy& accuracy, const float* output) const;

  std::uint32_t first_ = 0;
  bool normal_ = false, falling_ = false;
  std::vector<float> input_ = std::vector<float>(root_block_size);
  // The correctly rounded bits; where the inputs are normal numbers the result and its inverse, elsewhere the bits
  // that the hardware gives.
  std::vector<std::uint32_t> rounded_ = std::vector<std::uint32_t>(root_block_size);
  std::vector<std::uint32_t> hardware_ = std::vector<std::uint32_t>(root_block_size);
  std::vector<double> exact_ = std::vector<double>(root_block_size);
  std::vector<double> per_exact_ = std::vector<double>(root_block_size);
};

}  // namespace raylanes::bench
