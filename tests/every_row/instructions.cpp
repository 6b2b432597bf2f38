// A processor executes exactly the features that it reports: else an object with a forbidden instruction would pass.
#include <csetjmp>
#include <csignal>

#include <raylanes/cpu_features.hpp>

#include "../support/testing.hpp"

namespace raylanes::testing {
namespace {

sigjmp_buf before_instruction;
void is_illegal(int) {
  siglongjmp(before_instruction, 1);
}

bool executes(void (*instruction)()) {
  const auto old = std::signal(SIGILL, is_illegal);
  const bool returned = sigsetjmp(before_instruction, 1) == 0;
  if (returned) instruction();
  std::signal(SIGILL, old);
  return returned;
}

// One of each extension; LZCNT is BSR to older processors, and never illegal.
const struct {
  CpuFeature feature;
  void (*instruction)();
} extensions[] = {
#if defined(__aarch64__)
    {CpuFeature::asimd,
     [] {
       asm volatile("fadd v0.4s, v0.4s, v0.4s" ::: "v0");
     }},
#else
    {CpuFeature::sse3,
     [] {
       asm volatile("addsubps %%xmm0, %%xmm0" ::: "xmm0");
     }},
    {CpuFeature::ssse3,
     [] {
       asm volatile("pshufb %%xmm0, %%xmm0" ::: "xmm0");
     }},
    {CpuFeature::sse4_1,
     [] {
       asm volatile("pminsd %%xmm0, %%xmm0" ::: "xmm0");
     }},
    {CpuFeature::sse4_2,
     [] {
       asm volatile("pcmpgtq %%xmm0, %%xmm0" ::: "xmm0");
     }},
    {CpuFeature::popcnt,
     [] {
       asm volatile("popcnt %%eax, %%eax" ::: "eax");
     }},
    {CpuFeature::avx,
     [] {
       asm volatile("vaddps %%ymm0, %%ymm0, %%ymm0" ::: "xmm0");
     }},
    {CpuFeature::f16c,
     [] {
       asm volatile("vcvtph2ps %%xmm0, %%ymm0" ::: "xmm0");
     }},
    {CpuFeature::fma,
     [] {
       asm volatile("vfmadd231ps %%ymm0, %%ymm0, %%ymm0" ::: "xmm0");
     }},
    {CpuFeature::avx2,
     [] {
       asm volatile("vpaddd %%ymm0, %%ymm0, %%ymm0" ::: "xmm0");
     }},
    {CpuFeature::bmi1,
     [] {
       asm volatile("andn %%eax, %%eax, %%eax" ::: "eax");
     }},
    {CpuFeature::bmi2,
     [] {
       asm volatile("pdep %%eax, %%eax, %%eax" ::: "eax");
     }},
    {CpuFeature::aes,
     [] {
       asm volatile("aesenc %%xmm0, %%xmm0" ::: "xmm0");
     }},
    {CpuFeature::pclmulqdq,
     [] {
       asm volatile("pclmulqdq $0, %%xmm0, %%xmm0" ::: "xmm0");
     }},
    {CpuFeature::avx512f,
     [] {
       asm volatile("vaddps %%zmm0, %%zmm0, %%zmm0" ::: "xmm0");
     }},
#endif
};

TEST(Instructions, are_executed_where_the_processor_says_so) {
  for (const auto& [feature, instruction] : extensions) {
    const bool has = machine_features().contains({feature});
    // Only an emulator is sure to refuse the others: a virtual machine may hide what its processor executes.
    if (has || std::getenv("RAYLANES_EMULATED") != nullptr) {
      EXPECT_EQ(executes(instruction), has) << feature_names({feature});
    }
  }
}

}  // namespace
}  // namespace raylanes::testing
