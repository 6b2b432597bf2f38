// The view that the vocabulary test has of a path: for every operation and lane type a function that applies it to
// arrays of plain numbers. Compiled into the objects of the paths too: plain C types only.
#pragma once

#include <cstddef>

namespace raylanes {

// Reads n elements from each of `arity` operand arrays, a register at a time, and writes n results of the
// same width: the lanes themselves, or truth values as integers 0 and 1. n is a multiple of the
// lanes; arrays are aligned for their element type only.
using ProbeFunction = void (*)(const void* const* operands, void* results, std::size_t n);

struct Probe {
  const char* operation;
  int arity;
  ProbeFunction run;
};

// All operations on one kind of Lanes<T, N>.
struct ProbeGroup {
  // "float", "double", "uint32" or "uint64"; "node float", "node double" or "node word": what only some lanes have.
  const char* element;
  int lanes;
  const Probe* probes;
  std::size_t count;
};

struct ProbeTable {
  const ProbeGroup* groups;
  std::size_t count;
  int native_lanes;
  bool has_fma;
};

}  // namespace raylanes
