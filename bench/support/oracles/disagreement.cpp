#include "disagreement.hpp"

namespace raylanes::oracle {
namespace {

bool is_hit(const Hit& hit) {
  return hit.primitive != no_primitive;
}

struct Tracer {
  const char* name;
  Excuse when_wrong;
  const Hit& hit;
  Form form;
};

// One triangle as one form of test may see it.
struct View {
  ExactTriangleTest exact;
  ErrorBounds bounds;
  Class decision;
};

View look(const Ray& ray, const Triangle& triangle, Form form) {
  View view{exact_triangle(ray, triangle), {}, Class::must_miss};
  if (!view.exact.valid) return view;
  view.bounds = error_bounds(ray, triangle, view.exact, form);
  view.decision = classify(ray, view.exact, view.bounds);
  return view;
}

Triangle corners(std::span<const Float3> vertices, std::span<const Index3> triangles,
                 std::uint32_t primitive) {
  if (primitive >= triangles.size())
    throw std::invalid_argument("hit: primitive " + std::to_string(primitive) +
                                " is out of range, the mesh has " + std::to_string(triangles.size()) +
                                " triangles");
  Triangle out;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::uint32_t index = triangles[primitive][i];
    if (index >= vertices.size())
      throw std::invalid_argument("triangle " + std::to_string(primitive) + ": index " +
                                  std::to_string(index) + " is out of range, the mesh has " +
                                  std::to_string(vertices.size()) + " vertices");
    out.corner[i] = vertices[index];
  }
  return out;
}

bool near_edge(const View& view) {
  for (std::size_t i = 0; i < 3; ++i)
    if (abs(view.exact.weight[i]) <= view.bounds.weight[i]) return true;
  return false;
}

// Whether the float t can be what a tracer of this view's form computed; unbounded views allow all.
bool t_possible(const View& view, float t) {
  if (!view.bounds.t || !view.bounds.in_range) return true;
  return std::isfinite(t) && abs(mpq_class(t) - view.exact.t) <= *view.bounds.t;
}

std::string number(float t) {
  return std::to_string(t);
}

std::string triangle_name(std::uint32_t primitive) {
  return "triangle " + std::to_string(primitive);
}

Explanation wrong(const Tracer& tracer, const std::string& what) {
  return {tracer.when_wrong, std::string(tracer.name) + " " + what};
}

// Why `other` need not have accepted the triangle that `tracer` accepted; called when neither is wrong.
Explanation excuse(const Tracer& tracer, const Tracer& other, const View& own, const View& others) {
  const std::string begin =
      std::string("only ") + tracer.name + " accepted " + triangle_name(tracer.hit.primitive) + ": ";
  const bool either_own = own.decision == Class::either;
  const View& view = either_own ? own : others;
  if (!view.bounds.t || !view.bounds.in_range)
    return {Excuse::degenerate_triangle, begin + "its determinant is within rounding of zero"};
  if (near_edge(view)) return {Excuse::edge_rounding, begin + "the ray passes within rounding of its edge"};
  if (is_hit(other.hit))
    return {Excuse::same_depth, begin + other.name + " met triangle " + std::to_string(other.hit.primitive) +
                                    " within rounding of its t"};
  return {Excuse::depth_rounding,
          begin + "its t = " + number(tracer.hit.t) + " is within rounding of an end"};
}

class Judge {
 public:
  Judge(const Ray& ray, std::span<const Float3> vertices, std::span<const Index3> triangles)
      : ray_(ray), vertices_(vertices), triangles_(triangles) {}

  // `near` hit something that `far` passed over.
  Explanation judge(const Tracer& near, const Tracer& far) const {
    if (is_hit(far.hit))
      if (const Explanation bad = false_hit(far); bad.excuse != Excuse::none_needed) return bad;
    if (const Explanation bad = false_hit(near); bad.excuse != Excuse::none_needed) return bad;
    return is_hit(far.hit) && near.hit.primitive == far.hit.primitive ? same_triangle(near, far)
                                                                      : passed_over(near, far);
  }

 private:
  View view(std::uint32_t primitive, Form form, float tmax) const {
    Ray segment = ray_;
    segment.tmax = tmax;
    return look(segment, corners(vertices_, triangles_, primitive), form);
  }

  Explanation false_hit(const Tracer& tracer) const {
    const View own = view(tracer.hit.primitive, tracer.form, ray_.tmax);
    const std::string name = triangle_name(tracer.hit.primitive);
    if (own.decision == Class::must_miss) return wrong(tracer, "hit " + name + ", which has to be missed");
    if (!t_possible(own, tracer.hit.t))
      return wrong(tracer, "hit " + name + " with t = " + number(tracer.hit.t) + ", exact is " +
                               std::to_string(own.exact.t.get_d()));
    return {Excuse::none_needed, ""};
  }

  // Both t are within their bounds.
  Explanation same_triangle(const Tracer& near, const Tracer& far) const {
    const std::string end = triangle_name(near.hit.primitive) + " at t = " + number(near.hit.t) + " and " +
                            number(far.hit.t) + ", both within rounding";
    const View own = view(near.hit.primitive, near.form, ray_.tmax);
    const View others = view(near.hit.primitive, far.form, ray_.tmax);
    const bool bounded = own.bounds.t && others.bounds.t && own.bounds.in_range && others.bounds.in_range;
    return {bounded ? Excuse::same_depth : Excuse::degenerate_triangle, "both hit " + end};
  }

  // The other tracer's segment ends at its own hit: a triangle certainly nearer than that has to be hit.
  Explanation passed_over(const Tracer& near, const Tracer& far) const {
    const float end = is_hit(far.hit) ? std::min(far.hit.t, ray_.tmax) : ray_.tmax;
    const View others = view(near.hit.primitive, far.form, end);
    if (others.decision == Class::must_hit)
      return wrong(far, "passed over " + triangle_name(near.hit.primitive) + " at t = " + number(near.hit.t) +
                            ", which has to be hit");
    const View own = view(near.hit.primitive, near.form, end);
    return excuse(near, far, own, others);
  }

  const Ray& ray_;
  std::span<const Float3> vertices_;
  std::span<const Index3> triangles_;
};

}  // namespace

bool disagree(const Hit& ours, const Hit& theirs) {
  if (is_hit(ours) != is_hit(theirs)) return true;
  if (!is_hit(ours)) return false;
  const float difference = std::abs(ours.t - theirs.t);
  return !(ours.t == theirs.t || difference <= 1e-4f * std::max(std::abs(ours.t), std::abs(theirs.t)));
}

Explanation explain(const Ray& ray, std::span<const Float3> vertices, std::span<const Index3> triangles,
                    const Hit& ours, Form our_form, const Hit& theirs, Form their_form) {
  if (!disagree(ours, theirs)) return {Excuse::none_needed, "both agree"};
  const Tracer we{"ours", Excuse::ours_wrong, ours, our_form};
  const Tracer they{"theirs", Excuse::theirs_wrong, theirs, their_form};
  for (const Tracer& tracer : {we, they})
    if (is_hit(tracer.hit) && std::isnan(tracer.hit.t)) return wrong(tracer, "reports t = NaN");
  const Judge judge(ray, vertices, triangles);
  const bool ours_nearer = is_hit(ours) && (!is_hit(theirs) || ours.t < theirs.t);
  return ours_nearer ? judge.judge(we, they) : judge.judge(they, we);
}

}  // namespace raylanes::oracle
