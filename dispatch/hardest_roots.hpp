// The choices about square roots that depend on the machine: whether its estimates make Goldschmidt's roots correctly
// rounded, which some floats show, and how much the divider takes.
#pragma once

#include <raylanes/paths.hpp>

#include "table/roots.hpp"

namespace raylanes {

// The floats of [1, 4) whose root lies very near the middle of two floats: some estimate within 1.5·2^-12, as RSQRTPS
// documents, sends Goldschmidt's result to the wrong one. Elsewhere all is the same times a power of two. With
// RSQRT14PS' 2^-14 there are none. Found by all estimates, see tests/roots/estimates.cpp.
inline constexpr float hardest_roots[] = {
    0x1.24b0b2p+0f, 0x1.52f7dep+0f, 0x1.76c3eep+0f, 0x1.9b5d64p+0f, 0x1.a8cb02p+0f, 0x1.e05156p+0f,
    0x1.e1b39cp+0f, 0x1.f82294p+0f, 0x1.542efep+1f, 0x1.66057cp+1f, 0x1.771798p+1f, 0x1.9a2854p+1f,
    0x1.9b23d8p+1f, 0x1.a2b4eep+1f, 0x1.b5c076p+1f, 0x1.bebf4ap+1f, 0x1.dd26e4p+1f};

// The method of a caller or of an accuracy as this machine can keep its promise: the instruction instead of
// Goldschmidt's root, alone or beside the divider, where the path's own is wrong for one of these floats.
SqrtMethod kept_method(const RootKernels& roots, SqrtMethod method);

// The row of that method in the mix that is the fastest on a machine of which splits_512_bits() says so much: the
// result is the same, bit for bit. Throws std::invalid_argument if the method does not exist. A pure function.
ArrayFunction<float> fastest_sqrt(const RootKernels& roots, SqrtMethod method, bool splits_512_bits);

// The method that serves an accuracy on such a machine: where 512 bits take two passes, the correctly rounded root in
// that mix is faster than the one within 1 ULP, and takes its place. Throws std::invalid_argument if the accuracy does
// not exist. A pure function.
SqrtMethod serving_sqrt(const RootKernels& roots, Accuracy accuracy, bool splits_512_bits);

}  // namespace raylanes
