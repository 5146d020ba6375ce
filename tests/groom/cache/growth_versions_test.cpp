// SPDX-License-Identifier: Apache-2.0
// The results of every step of growth are those recorded with its version (growth_version, OperatorTraits).
#include <fstream>
#include <set>

#include "geom/closest_point.h"
#include "geom/io/strand_file.h"
#include "geom/tessellation.h"
#include "tests/groom/cached_coats.h"
#include "tests/support/recorded_results.h"

namespace pelage::growth_versions_test {
namespace {

class GrowthVersions : public CachedCoatTest {
 protected:
  RecordedResults::Versions versions_of(const GroomParams& params) const {
    auto versions = growth_versions(GroomIdentity(params, 1, OperatorStack(params.operators), rest_.get()));
    if (params.cache) versions.emplace_back("frozen", growth_version::kFrozen);
    versions.emplace_back("pose", growth_version::kPose);
    return versions;
  }
  static std::string constant(const std::string& name) {
    return "growth_version::" + name + " in groom/cache/groom_identity.h";
  }

  /// The strands of a coat at rest.
  void check_coat(const std::string& stage, const Coat& coat, const std::string& change) {
    check_groom(stage, params_of(coat), change);
  }
  void check_groom(const std::string& stage, const GroomParams& params, const std::string& change,
                   const std::function<StageResult(const Groom&)>& result_of = {}) {
    const auto groom = make(params);
    recorded_.check(stage, versions_of(params), change, result_of ? result_of(*groom) : at_rest_of(*groom));
  }
  StageResult at_rest_of(const Groom& groom) const {
    const View view{V3f(0), 1e9f};
    const SkinMesh mesh = tessellate({rest_.get(), 1}, view, {4, 8}, workers_);
    const ClosestPointTree tree(mesh, 0);
    PosedSkin skin = at_rest();
    skin.trees = {&tree, 1};
    StageResult result;
    add(groom, skin, {}, result);
    return result;
  }
  static void add(const Groom& groom, const PosedSkin& skin, const std::string& name, StageResult& result,
                  const KeptStrands* kept = nullptr) {
    std::vector<float> points, radii, roots, attributes;
    std::vector<uint64_t> ids;
    for (size_t leaf = 0; leaf < groom.follicles().leaves().size(); ++leaf) {
      const Strands strands = groom.grow(leaf, skin, kept);
      for (int key = 0; key < strands.motion_keys(); ++key) {
        for (size_t i = 0; i < strands.point_count(); ++i) {
          const std::span<const float> p = strands.points(key).subspan(4 * i, 4);
          points.insert(points.end(), p.begin(), p.begin() + 3);
          radii.push_back(p[3]);
        }
      }
      for (size_t s = 0; s < strands.strand_count(); ++s) {
        ids.push_back(strands.id(s));
        roots.insert(roots.end(), {strands.root_uv(s).x, strands.root_uv(s).y});
      }
      for (const StrandAttribute& a : strands.attributes())
        attributes.insert(attributes.end(), a.values.begin(), a.values.end());
      const Box3f box = groom.conservative_bound(leaf, skin);
      for (const V3f& corner : {box.min, box.max}) roots.insert(roots.end(), {corner.x, corner.y, corner.z});
    }
    result.add(name + "points", points);
    result.add(name + "radii", radii);
    result.add(name + "ids", ids);
    result.add(name + "roots and bounds", roots);
    result.add(name + "attributes", attributes);
  }

  RecordedResults recorded_;
};

/// Strands on the ball that lean away from its normals, in a file.
void write_guides(const std::filesystem::path& file, const LimitSurface& rest, int per_side) {
  StrandArrays arrays;
  arrays.first_point.push_back(0);
  for (uint32_t face = 0; face < rest.topology().face_count(); ++face) {
    for (int i = 0; i < per_side * per_side; ++i) {
      const auto n = static_cast<float>(per_side);
      const float u = (static_cast<float>(i % per_side) + 0.5f) / n,
                  v = (static_cast<float>(i / per_side) + 0.5f) / n;
      const Frame frame = rest.frame(face, u, v);
      const V3f root = rest.evaluate(face, u, v).position;
      for (int p = 0; p < 5; ++p) {
        const float t = static_cast<float>(p) / 4;
        const V3f point =
            root + (frame.normal + frame.tangent * (t * (0.5f + v)) + frame.bitangent * u) * (0.4f * t);
        arrays.points.insert(arrays.points.end(), {point.x, point.y, point.z, 0.01f * (1 - t)});
      }
      arrays.first_point.push_back(static_cast<uint32_t>(arrays.points.size() / 4));
      arrays.ids.push_back(arrays.ids.size());
    }
  }
  write_strands(file, Strands(std::move(arrays)));
}

TEST_F(GrowthVersions, Skins) {
  ControlMesh creased = shapes::ball_cage();
  creased.creases.push_back({0, 1, 1.5f});
  ControlMesh pyramid = shapes::ball_cage();  // a triangle fan on a square
  pyramid.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}, {0, 0.25f, 1}};
  pyramid.face_sizes.assign(4, 3);
  pyramid.face_vertices = {0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, 4};
  pyramid.face_groups.assign(4, 0);
  const ControlMesh open = shapes::grid_cage(3, 2, [](float u, float v) { return V3f(u, v, u * v * v); });
  const auto add = [](const ControlMesh& mesh, SubdivisionScheme scheme, BoundaryRule boundary,
                      const std::string& name, StageResult& result) {
    const LimitSurface surface(SurfaceTopology::create(mesh, scheme, boundary, name), mesh.positions);
    std::vector<float> values;
    for (uint32_t face = 0; face < surface.topology().face_count(); ++face) {
      for (int i = 0; i < 49; ++i) {
        const float u = static_cast<float>(i % 7) / 12, v = static_cast<float>(i / 7) / 12;
        const SurfacePoint point = surface.evaluate(face, u, v);
        const Frame frame = surface.frame(face, u, v);
        for (const V3f& x :
             {point.position, point.du, point.dv, frame.tangent, frame.bitangent, frame.normal})
          values.insert(values.end(), {x.x, x.y, x.z});
        const V2f uv = surface.topology().texture_coordinates(face, u, v);
        values.insert(values.end(), {uv.x, uv.y});
      }
    }
    result.add(name, values);
  };
  StageResult result;
  using enum SubdivisionScheme;
  using enum BoundaryRule;
  add(creased, kCatmullClark, kEdgeAndCorner, "creased", result);
  add(open, kCatmullClark, kEdgeAndCorner, "open", result);
  add(open, kCatmullClark, kEdgeOnly, "round", result);
  add(open, kBilinear, kEdgeAndCorner, "bilinear", result);
  add(pyramid, kLoop, kEdgeAndCorner, "loop", result);
  add(pyramid, kNone, kEdgeAndCorner, "flat", result);
  recorded_.check("skin", {{"skin", growth_version::kSkin}}, constant("kSkin"), result);
}

/// Writes a Radiance image of 4 by 3 pixels.
std::string small_map(const std::filesystem::path& file) {
  std::ofstream out(file, std::ios::binary);
  out << "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 3 +X 4\n";
  for (int i = 0; i < 12; ++i) {
    for (const int byte : {20 * i, 250 - 17 * i, (91 * i) % 256, 128}) out.put(static_cast<char>(byte));
  }
  return "map: " + file.string();
}

TEST_F(GrowthVersions, Fields) {
  const std::string map = small_map(folder_.path() / "map.hdr");
  StageResult result;
  int number = 0;
  for (const std::string& text :
       {std::string("[0.1, 0.2, 0.3]"), "{" + map + "}", "{" + map + ", channel: g, range: [0.2, 3]}",
        "{" + map + ", channel: b, space: srgb}", "{" + map + ", space: srgb}",
        std::string("{ramp: {along: strand, knots: [[0, 0.1], [0.4, [1, 2, 3]], [1, 0.2]]}}"),
        std::string("{ramp: {along: v, knots: [[0.2, 0.1], [0.9, 0.7]]}}"),
        std::string("{ramp: {along: y, knots: [[-1, 0], [1, 1]]}}"),
        std::string("{noise: {frequency: 3, amplitude: 2, offset: 0.5, seed: 4}}"),
        std::string("{attribute: clump}"),
        std::string("{product: [0.5, {attribute: random}, {noise: {frequency: 1}}]}")}) {
    const Field field = scene_text::read<Field>(text).with_textures(textures_);
    std::vector<float> values;
    for (int i = 0; i < 200; ++i) {
      TestRandom random(static_cast<uint64_t>(i));
      const FieldAttribute attributes[] = {{"random", Rgb(random.unit())}, {"clump", Rgb(random.unit())}};
      V3f at;  // one after the other: the order of a function's arguments depends on the compiler
      for (int axis = 0; axis < 3; ++axis) at[axis] = random.between(-2, 2);
      const FieldPoint point{at, random.between(-1, 2), random.unit(), random.unit(), attributes};
      const Rgb color = field.color(point);
      values.insert(values.end(), {color.x, color.y, color.z, field.value(point)});
    }
    values.insert(values.end(), {field.value_range().first, field.value_range().second});
    result.add("field " + std::to_string(number++), values);
  }
  recorded_.check("fields", {{"fields", growth_version::kFields}}, constant("kFields"), result);
}

/// Grown strands always have one.
constexpr const char* kWidth = "- width: {root: 0.02, tip: 0.01}\n";

TEST_F(GrowthVersions, StrandsAndPoints) {
  const Coat dense{kWidth, "", 900, 300, 4, "density: {ramp: {along: y, knots: [[-1, 0.2], [1, 1]]}}\n"};
  check_coat("follicles", dense, constant("kStrands"));
  const Coat by_area{kWidth, "", 900, 300, 4};
  GroomParams params = params_of(by_area);
  params.strands.reset();
  params.density = Field(70.0f);
  check_groom("follicles by area", params, constant("kStrands"));
  for (const char* attach : {"skin", "none"}) {
    params = GroomParams();
    params.strands_file = {folder_.path() / "strands.hair", {}};
    write_guides(params.strands_file.path, *rest_, 6);
    params.attach = *attach == 's' ? Attachment::kSkin : Attachment::kNone;
    params.leaf_strands = 100;
    check_groom(std::string("strands of a file, attach ") + attach, params, constant("kStrands"));
  }
  check_coat("points", {kWidth, "", 300, 100, 13}, constant("kPoints"));
}

TEST_F(GrowthVersions, Operators) {
  const auto guides = folder_.path() / "guides.hair";
  write_guides(guides, *rest_, 2);
  const auto obstacle = folder_.path() / "obstacle.obj";
  std::ofstream(obstacle)
      << "v 0 2 0\nv -1 1.1 -1\nv 1 1.1 -1\nv 0 1.1 1\nf 1 3 2\nf 1 4 3\nf 1 2 4\nf 2 3 4\n";
  // Each with most of its keys, on strands that already differ from each other.
  const std::vector<std::pair<std::string, std::string>> all{
      {"length", "{value: {ramp: {along: y, knots: [[-1, 0.2], [1, 0.5]]}}, scale: 1.1, variation: 0.3}"},
      {"comb", "{direction: [0, -1, 0.3], lift: 0.3, amount: 0.8, curve: 0.5}"},
      {"part",
       "{points: [[0, 0.3, -1], [0.1, 0.3, 0], [0, 0.3, 1]], width: 0.6, lift: 0.1, amount: 0.9, curve: "
       "0.4}"},
      {"wet", "{spacing: 0.3, gather: 0.8, profile: 1.2, weight: 50, flatten: 0.4, amount: 0.9}"},
      {"braid", "{style: twist, spacing: 0.3, radius: 0.03, pitch: 0.2, thickness: 0.5, amount: 0.9}"},
      {"avoid", "{mesh: " + obstacle.string() + ", offset: 0.02, iterations: 3}"},
      {"swirl", "{center: [0, 1, 0], radius: 0.9, angle: 60, lift: 0.2, amount: 0.9, curve: 0.3}"},
      {"bend", "{direction: [1, 0, 0], angle: 70, start: 0.2, profile: 1.5, variation: 0.4}"},
      {"clump",
       "{spacing: 0.3, amount: 0.6, root: 0.1, profile: 1.3, variation: 0.3, strays: 0.1, levels: [{spacing: "
       "0.1, "
       "amount: 0.5}]}"},
      {"curl", "{radius: 0.02, turns: 2, angle_variation: 0.7, start: 0.3}"},
      {"frizz", "{amplitude: 0.03, frequency: 3}"},
      {"noise", "{amplitude: 0.1, frequency: 2, frequency_along: 1.5, profile: 1.2}"},
      {"guides",
       "{file: " + guides.string() + ", neighbours: 3, radius: 0.6, growth_radius: 0.5, amount: 0.9}"},
      {"push_out", "{offset: 0.03, iterations: 3}"},
      {"width", "{root: {product: [0.01, {attribute: random}]}, tip: 0.001, profile: 2, variation: 0.2}"},
      {"color",
       "{value: {product: [{attribute: clump}, {ramp: {along: strand, knots: [[0, [0, 1, 0]], [1, [1, 0, "
       "0]]]}}]}, "
       "variation: 0.5}"}};
  std::set<std::string> seen;
  for (const auto& [name, keys] : all) {
    std::string operators = "- length: {value: 0.5, variation: 0.4}\n";
    // Something to push out.
    if (name == "push_out") operators += "- noise: {amplitude: 0.6, frequency: 3}\n";
    operators += "- " + name + ": " + keys + "\n";
    if (name != "width") operators += kWidth;
    check_coat(name, {operators, "", 600, 300, 9}, "`.version` in traits() of the operator " + name);
    seen.insert(name);
  }
  for (const SchemaInfo* schema : ValueReader<OperatorList>::blocks())
    EXPECT_TRUE(seen.count(schema->name()) || schema->name() == "operator mask" || schema->name() == "python")
        << "add the operator " << schema->name() << " here";
}

TEST_F(GrowthVersions, FrozenAndPosedStrands) {
  check_coat("frozen", {kEveryFrozenOperator, "color", 600, 300}, constant("kFrozen"));
  check_coat("frozen, with live operators",
             {std::string(kEveryFrozenOperator) + "- push_out: {}\n", "comb", 600, 300}, constant("kFrozen"));
  const LimitSurface pose = posed(0.7f, 0.2f);
  const LimitSurface both[] = {*rest_, pose};
  check_groom("pose", params_of({kEveryFrozenOperator, "", 600, 300}), constant("kPose"),
              [&](const Groom& groom) {
                StageResult result;
                const PosedSkin moving{both, {}, 1.3f, {}, 0.8f};
                add(groom, moving, "moving ", result);
                const std::vector<uint32_t> some{0, 1, 17, 255, 256};
                const std::vector<float> width{1, 2, 3, 4, 5}, contrast{1, 0.5f, 0, 0.25f, 0.75f};
                const KeptStrands kept{some, width, contrast};
                add(groom, moving, "kept ", result, &kept);
                return result;
              });
}

}  // namespace
}  // namespace pelage::growth_versions_test
