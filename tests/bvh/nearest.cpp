// Meshes of every kind as people hand them to a tree, and the results of single rays.
#include <raylanes/raylanes.hpp>

#include "../support/message_of.hpp"
#include "../support/random_input.hpp"
#include "../support/same_bytes.hpp"
#include "../traverse/reference/traced.hpp"

namespace raylanes::testing {
namespace {

struct Vertex {
  float x, y, z;
  unsigned colour;
};
struct Named {
  int name;
};
struct NamedVertex : Named, Vertex {};
struct Elements {
  double weight;
  float number[3];
  const float& operator[](std::size_t i) const { return number[i]; }
};
struct Face {  // tells nothing about its numbers
  std::int32_t corner0, corner1, corner2;
  std::int16_t material;
};

// The same triangles as the mesh in every form that they come in.
TEST(Queries, takes_meshes_as_people_have_them) {
  const Mesh mesh = triangle_soup(60, 0.4f, 61);
  const std::vector<Ray> rays = mixed_rays(mesh, 200, 2, {0, 0, 0}, 62);
  std::vector<float> flat_vertices;
  std::vector<Vertex> vertices;
  std::vector<NamedVertex> named;
  std::vector<Elements> elements;
  std::vector<std::array<float, 4>> padded;
  for (const Float3& v : mesh.vertices) {
    flat_vertices.insert(flat_vertices.end(), v.begin(), v.end());
    vertices.push_back({v[0], v[1], v[2], 7});
    named.push_back({{9}, vertices.back()});
    elements.push_back({0.5, {v[0], v[1], v[2]}});
    padded.push_back({v[0], v[1], v[2], nan});
  }
  std::vector<int> flat_indices;
  std::vector<unsigned> flat_unsigned;
  std::vector<Face> faces;
  std::vector<std::array<int, 3>> signed_indices;
  for (const Index3& t : mesh.triangles) {
    const std::array<int, 3> s{static_cast<int>(t[0]), static_cast<int>(t[1]), static_cast<int>(t[2])};
    flat_indices.insert(flat_indices.end(), s.begin(), s.end());
    flat_unsigned.insert(flat_unsigned.end(), t.begin(), t.end());
    faces.push_back({s[0], s[1], s[2], 9});
    signed_indices.push_back(s);
  }
  const std::vector<Hit> expected = trace(Bvh(mesh), rays, {});
  const VertexView vertex_views[] = {mesh.vertices,
                                     flat_vertices,
                                     vertices,
                                     named,
                                     elements,
                                     padded,
                                     std::span(vertices),
                                     {flat_vertices.data(), mesh.vertices.size()},
                                     {&vertices[0].x, vertices.size(), sizeof(Vertex)}};
  const IndexView index_views[] = {mesh.triangles,
                                   flat_indices,
                                   flat_unsigned,
                                   signed_indices,
                                   {flat_indices.data(), mesh.triangles.size()},
                                   {&faces[0].corner0, faces.size(), sizeof(Face)}};
  for (const VertexView& v : vertex_views)
    for (const IndexView& i : index_views) {
      const std::vector<Hit> hits = trace(Bvh(v, i), rays, {});
      EXPECT_TRUE(same_bytes(hits, expected));
    }
}

TEST(Queries, takes_plain_arrays_and_unaligned_ones) {
  const float vertices[] = {-1, -1, 0, 1, -1, 0, 0, 1, 0};
  const float rows[3][3] = {{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}};
  const int triangles[] = {0, 1, 2};
  alignas(4) char bytes[1 + sizeof vertices];
  std::memcpy(bytes + 1, vertices, sizeof vertices);
  const Ray ray = make_ray({0, 0, 3}, {0, 0, -1});
  EXPECT_EQ(Bvh(vertices, triangles).closest(ray).t, 3.0f);
  EXPECT_EQ(Bvh(rows, triangles).closest(ray).t, 3.0f);
  EXPECT_EQ(Bvh(VertexView(bytes + 1, 3), triangles).closest(ray).t, 3.0f);
}

struct Gap {
  float x, gap, y, z;
};
TEST(Queries, refuses_what_is_no_mesh) {
  const std::vector<float> ten(10, 0.0f), nine(9, 0.0f);
  const std::vector<int> good{0, 1, 2}, negative{0, -1, 2}, four{0, 1, 2, 0}, large{0, 1, 3};
  const auto message = [](const VertexView& v, const IndexView& i) {
    return message_of<std::invalid_argument>([&] { Bvh(v, i); });
  };
  EXPECT_NE(message_of<std::invalid_argument>([&] { Bvh(ten, good); }).find("10"), std::string::npos);
  EXPECT_NE(message_of<std::invalid_argument>([&] { Bvh(nine, four); }).find("4"), std::string::npos);
  EXPECT_NE(message(nine, negative).find("-1"), std::string::npos) << message(nine, negative);
  EXPECT_NE(message(nine, large).find("index 3"), std::string::npos) << message(nine, large);
  EXPECT_NE(message({nullptr, 3}, good).find("nothing"), std::string::npos);
  EXPECT_NE(message(nine, {static_cast<const int*>(nullptr), 1}).find("nothing"), std::string::npos);
  const std::vector<Gap> with_gap(3);
  expect_words(message_of<std::invalid_argument>([&] { Bvh(with_gap, good); }), {"vertices", "three"});
  EXPECT_EQ(message(nine, good), "no exception");
  EXPECT_EQ(message({}, {}), "no exception");
}

struct Doubles {
  double x, y, z;
};
struct OtherDoubles {
  double a, b, c;
};
struct Mixed {
  float x, y;
  double z;
};
static_assert(!std::is_constructible_v<VertexView, std::vector<double>>);
static_assert(!std::is_constructible_v<VertexView, std::vector<Doubles>>);
static_assert(!std::is_constructible_v<VertexView, std::vector<OtherDoubles>>,
              "it does not tell what it holds");
static_assert(!std::is_constructible_v<VertexView, std::vector<Mixed>>);
static_assert(!std::is_constructible_v<VertexView, std::vector<std::array<double, 3>>>);
static_assert(!std::is_constructible_v<IndexView, std::vector<Face>>);
static_assert(!std::is_constructible_v<VertexView, std::vector<std::array<float, 2>>>);
static_assert(!std::is_constructible_v<VertexView, std::vector<std::vector<float>>>);
static_assert(!std::is_constructible_v<VertexView, std::vector<std::span<float>>>);
static_assert(!std::is_constructible_v<VertexView, std::vector<float*>>);
static_assert(!std::is_constructible_v<IndexView, std::vector<float>>);
static_assert(!std::is_constructible_v<IndexView, std::vector<std::int64_t>>);

}  // namespace
}  // namespace raylanes::testing
