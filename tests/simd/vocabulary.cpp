// Every operation of the vocabulary on every path against plain scalar code, bit for bit.

#include "../../bench/support/rulers/of_path.hpp"
#include "../support/guarded_array.hpp"
#include "../support/supported_paths.hpp"
#include "vocabulary_inputs.hpp"
#include "vocabulary_probe.hpp"
#include "vocabulary_reference.hpp"

namespace raylanes {

// Defined in the probe objects; the build lists the paths: RAYLANES_EACH_PATH(visit) is visit(scalar)...
namespace detail {
#define RAYLANES_DECLARE(path) extern const ProbeTable path##_probes;
RAYLANES_EACH_PATH(RAYLANES_DECLARE)
}  // namespace detail

namespace testing {
namespace {

#define RAYLANES_PROBES(path) &detail::path##_probes,
constexpr const ProbeTable* all_probes[] = {RAYLANES_EACH_PATH(RAYLANES_PROBES)};

// An array at an address that is aligned for its elements and for nothing wider.
template <class B>
class Unaligned {
 public:
  explicit Unaligned(const std::vector<B>& values) : bytes_(sizeof(B) * values.size() + 128) {
    void* start = bytes_.data();
    std::size_t space = bytes_.size();
    begin_ = static_cast<unsigned char*>(std::align(64, 64, start, space)) + sizeof(B);
    std::memcpy(begin_, values.data(), sizeof(B) * values.size());
  }
  Unaligned(const Unaligned&) = delete;
  Unaligned& operator=(const Unaligned&) = delete;
  void* get() { return begin_; }
  B operator[](std::size_t i) const {
    B value;
    std::memcpy(&value, begin_ + i * sizeof(B), sizeof(B));
    return value;
  }

 private:
  std::vector<unsigned char> bytes_;
  unsigned char* begin_;
};

template <class T>
bool agrees(const Reference<T>& reference, Bits<T> expected, Bits<T> found) {
  if (expected == found) return true;
  if constexpr (!std::is_floating_point_v<T>) return false;
  const T a = std::bit_cast<T>(expected), b = std::bit_cast<T>(found);
  if (reference.tolerance == 0.0) return reference.rounds && a != a && b != b;
  if (a != a || b != b) return a != a && b != b;
  const double exact = static_cast<double>(a);
  return std::fabs(static_cast<double>(b) - exact) <= reference.tolerance * std::fabs(exact);
}

template <class T>
std::string operands_at(const std::vector<std::vector<Bits<T>>>& operands, std::size_t i) {
  std::ostringstream text;
  text << std::hex;
  for (const auto& operand : operands) text << " 0x" << operand[i];
  return text.str();
}

// Runs one operation over all its inputs and reports the first difference. Counts the results compared.
template <class T>
void check(const Reference<T>& reference, const Probe& probe, std::size_t lanes, std::size_t& compared) {
  ASSERT_EQ(probe.arity, reference.arity);
  const bool masks = reference.inputs == Inputs::masks;
  const auto operands = masks ? masks_for<T>(lanes) : values_for<T>(reference.arity);
  const std::size_t n = operands.front().size();
  ASSERT_EQ(n % lanes, 0u);

  const auto sentinel = static_cast<Bits<T>>(0xa5a5a5a5a5a5a5a5u);
  std::vector<Bits<T>> expected(n + lanes, sentinel);
  for (std::size_t i = 0; i < n; i += lanes) {
    Register<T> r{lanes, i / lanes, {}};
    for (std::size_t k = 0; k < operands.size(); ++k) r.operand[k] = operands[k].data() + i;
    reference.apply(r, expected.data() + i);
  }

  Unaligned<Bits<T>> results(std::vector<Bits<T>>(n + lanes, sentinel));
  std::vector<std::unique_ptr<Unaligned<Bits<T>>>> copies;
  std::vector<const void*> pointers;
  for (const auto& operand : operands) {
    copies.push_back(std::make_unique<Unaligned<Bits<T>>>(operand));
    pointers.push_back(copies.back()->get());
  }
  probe.run(pointers.data(), results.get(), n);
  for (std::size_t i = 0; i < n; ++i) {
    ASSERT_TRUE(agrees<T>(reference, expected[i], results[i]))
        << "lane " << i % lanes << " of register " << i / lanes << ", operands" << operands_at<T>(operands, i)
        << std::hex << ": expected 0x" << expected[i] << ", found 0x" << results[i];
  }
  for (std::size_t i = n; i < n + lanes; ++i) ASSERT_EQ(results[i], sentinel) << "written past the end";
  compared += n;
}

// Every operation of the references, and no other, on groups of so many lanes.
template <class T>
void check_lanes(const ProbeTable& table, const std::string& element, int lanes,
                 const std::vector<Reference<T>>& references) {
  std::map<std::string, Probe> probes;
  for (std::size_t g = 0; g < table.count; ++g) {
    const ProbeGroup& group = table.groups[g];
    if (group.element != element || group.lanes != lanes) continue;
    for (std::size_t i = 0; i < group.count; ++i) probes[group.probes[i].operation] = group.probes[i];
  }
  EXPECT_EQ(probes.size(), references.size());
  std::size_t compared = 0;
  for (const Reference<T>& reference : references) {
    SCOPED_TRACE(element + " x " + std::to_string(lanes) + ": " + reference.operation);
    const auto probe = probes.find(reference.operation);
    ASSERT_NE(probe, probes.end()) << "not probed";
    check(reference, probe->second, static_cast<std::size_t>(lanes), compared);
  }
  std::printf("%s x %d: %zu results of %zu operations\n", element.c_str(), lanes, compared,
              references.size());
}

// The same on every group of lanes of T.
template <class T>
void check_all(const ProbeTable& table, const std::string& element,
               const std::vector<Reference<T>>& references) {
  std::set<int> widths;
  for (std::size_t g = 0; g < table.count; ++g)
    if (table.groups[g].element == element) widths.insert(table.groups[g].lanes);
  const int native = sizeof(T) == 4 ? table.native_lanes : std::max(table.native_lanes / 2, 1);
  EXPECT_TRUE(widths.contains(native));
  EXPECT_TRUE(table.native_lanes < 16 || widths.contains(native / 2));

  for (const int lanes : widths) check_lanes(table, element, lanes, references);
}

class Vocabulary : public ::testing::TestWithParam<const Path*> {
 protected:
  const Path& path() const { return *GetParam(); }
  const ProbeTable& probes() const { return of_path(path(), all_probes); }
  void SetUp() override { ASSERT_EQ(std::size(all_probes), paths().size()); }
  // Said by the list of paths, not by the probes.
  bool fuses() const {
    return path().required.contains({CpuFeature::fma}) || path().required.contains({CpuFeature::asimd});
  }
};

TEST_P(Vocabulary, describes_its_path) {
  EXPECT_EQ(probes().native_lanes, path().lanes);
  EXPECT_EQ(probes().has_fma, fuses());
  EXPECT_EQ(path().has_fma(), fuses());
}

TEST_P(Vocabulary, float) {
  check_all(probes(), "float", number_references<float>(fuses()));
}
TEST_P(Vocabulary, double) {
  check_all(probes(), "double", number_references<double>(fuses()));
}
TEST_P(Vocabulary, uint32) {
  check_all(probes(), "uint32", integer_references<std::uint32_t>());
}
TEST_P(Vocabulary, uint64) {
  check_all(probes(), "uint64", integer_references<std::uint64_t>());
}

// Only on paths with eight lanes and FMA.
TEST_P(Vocabulary, lanes_of_nodes) {
  if (!fuses() || path().lanes < 8) {
    for (std::size_t g = 0; g < probes().count; ++g)
      EXPECT_FALSE(std::string_view(probes().groups[g].element).starts_with("node"));
    return;
  }
  check_lanes(probes(), "node float", 4, four_references<float>());
  check_lanes(probes(), "node double", 4, four_references<double>());
  check_lanes(probes(), "node word", 8, eight_word_references());
}

// A mask of `lanes` lanes with its words as the probes of partial loads and stores want them: `first` lanes, or
// the lanes of `first` as bits.
template <class T>
void expect_untouched(const Probe& probe, std::size_t lanes, bool by_mask, Bits<T> word) {
  const auto takes_part = [&](std::size_t i) { return by_mask ? (word >> i & 1u) != 0 : i < word; };
  std::size_t least = 0, end = lanes;
  while (least < lanes && !takes_part(least)) ++least;
  while (end > least && !takes_part(end - 1)) --end;
  std::vector<Bits<T>> words(lanes, word), values(lanes), fillers(lanes, 7);
  for (std::size_t i = 0; i < lanes; ++i) values[i] = Bits<T>(100 + i);
  const bool loads = probe.arity == 3;
  for (const Place place : {Place::before_guard, Place::after_guard}) {
    // The first or the last lane that takes part lies beside the page that may not be touched.
    GuardedArray<Bits<T>> array(lanes, place);
    for (std::size_t i = 0; i < lanes; ++i) array[i] = 50;
    Bits<T>* const data = array.data() + (place == Place::before_guard ? lanes - end : std::size_t{0});
    Bits<T>* const p = place == Place::before_guard ? data : data - least;
    std::vector<Bits<T>> found(lanes);
    if (loads) {
      for (std::size_t i = 0; i < lanes; ++i)
        if (takes_part(i)) p[i] = values[i];
      const void* const operands[] = {words.data(), p, fillers.data()};
      probe.run(operands, found.data(), lanes);
    } else {
      const void* const operands[] = {words.data(), values.data()};
      probe.run(operands, p, lanes);
      for (std::size_t i = 0; i < lanes; ++i) found[i] = takes_part(i) ? p[i] : Bits<T>(7);
    }
    std::size_t changed = 0;
    for (std::size_t i = 0; i < lanes; ++i) {
      ASSERT_EQ(found[i], takes_part(i) ? values[i] : 7u) << "lane " << i << " of word " << word;
      changed += array[i] == 50 ? 0u : 1u;
    }
    std::size_t taking_part = 0;
    for (std::size_t i = 0; i < lanes; ++i) taking_part += takes_part(i) ? 1u : 0u;
    ASSERT_EQ(changed, taking_part) << "word " << word;
    ASSERT_TRUE(array.is_intact()) << "word " << word;
  }
}

template <class T>
void expect_all_untouched(const ProbeTable& table, std::string_view element) {
  std::size_t tried = 0;
  for (std::size_t g = 0; g < table.count; ++g)
    for (std::size_t k = 0; table.groups[g].element == element && k < table.groups[g].count; ++k) {
      const Probe& probe = table.groups[g].probes[k];
      const std::string operation = probe.operation;
      const bool by_mask = operation.ends_with("_mask");
      if (!by_mask && !operation.ends_with("_first")) continue;
      SCOPED_TRACE(std::string(element) + " x " + std::to_string(table.groups[g].lanes) + ": " + operation);
      const auto lanes = static_cast<std::size_t>(table.groups[g].lanes);
      for (std::size_t word = 0; word < (by_mask ? std::size_t{1} << lanes : lanes + 1); ++word)
        expect_untouched<T>(probe, lanes, by_mask, static_cast<Bits<T>>(word)), ++tried;
    }
  EXPECT_GT(tried, 0u);
}

TEST_P(Vocabulary, lanes_left_out_are_not_touched_beside_guard_pages) {
  expect_all_untouched<float>(probes(), "float");
  expect_all_untouched<double>(probes(), "double");
}

INSTANTIATE_TEST_SUITE_P(OnEveryPath, Vocabulary, ::testing::ValuesIn(supported_paths()), path_name);

}  // namespace
}  // namespace testing
}  // namespace raylanes
