// Two instructions that Armv8.0-A lacks, an atomic addition of Armv8.1-A and a cryptographic one: the gate `symbols`
// must refuse the object.
namespace raylanes::detail {

extern const int planted;
const int planted = 1;

}  // namespace raylanes::detail

namespace {

[[gnu::used]] void use_them() {
  asm volatile(
      ".arch armv8-a+lse+crypto\n ldadd w0, w1, [x2]\n aese v0.16b, v1.16b\n fmul v0.4s, v0.4s, v0.4s");
}

}  // namespace
