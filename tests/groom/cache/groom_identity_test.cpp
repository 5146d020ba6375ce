// SPDX-License-Identifier: Apache-2.0
#include "groom/cache/groom_identity.h"

#include <fstream>
#include <set>

#include "geom/io/strand_file.h"
#include "groom/operators/operator_list.h"
#include "tests/groom/cached_coats.h"

namespace pelage {
namespace {

class GroomIdentityTest : public CachedCoatTest {
 protected:
  ContentHash hash_of(const GroomParams& params, uint64_t seed = 7) const {
    const OperatorStack stack(params.operators);
    return GroomIdentity(params, seed, stack, rest_.get()).whole();
  }
  ContentHash hash_of(const std::string& operators) const {
    GroomParams params;
    params.operators = scene_text::read<OperatorList>(operators);
    return hash_of(params);
  }
};

/// Two values that the key may have, of its type.
std::pair<std::string, std::string> two_values(const KeyInfo& key, const std::string& file,
                                               const std::string& other_file) {
  const std::string& type = key.type;
  if (type.find("file") != std::string::npos) return {file, other_file};
  if (type == "true or false") return {"true", "false"};
  if (type == "text") return {"one", "other"};
  if (type == "block of values") return {"{a: 1}", "{a: 1.5}"};
  if (type.find("list of 3 numbers") != std::string::npos) return {"[[1, 2, 3]]", "[[1, 2, 3.5]]"};
  if (type.find("list") != std::string::npos)
    return {"[{spacing: 0.1, amount: 0.5}]", "[{spacing: 0.1, amount: 0.25}]"};
  if (type.find("3 numbers") != std::string::npos) return {"[1, 2, 3]", "[1, 2, 3.5]"};
  if (type == "integer") return {"2", "3"};
  if (type.find("number") != std::string::npos || type == "field" || type == "colour") return {"0.5", "0.75"};
  // An enumeration: "a | b".
  const size_t bar = type.find(" | ");
  EXPECT_NE(bar, std::string::npos) << key.name << ": " << type;
  return {type.substr(0, bar), type.substr(bar + 3, type.find(" | ", bar + 3) - bar - 3)};
}

TEST_F(GroomIdentityTest, FilesThatAFileOfUsdNamesCount) {
  const auto write = [&](const char* name, const std::string& text) {
    std::ofstream(folder_.path() / name) << "#usda 1.0\n" << text;
  };
  write("main.usda", "def \"a\" (payload = @leaf.usda@</h>) {}");
  write("leaf.usda", "def BasisCurves \"h\" {}");
  GroomParams params;
  params.strands_file.path = folder_.path() / "main.usda";
  const ContentHash before = hash_of(params);
  EXPECT_EQ(hash_of(params), before);
  write("leaf.usda", "def BasisCurves \"h\" { int[] curveVertexCounts = [3] }");
  EXPECT_NE(hash_of(params), before);
}

TEST_F(GroomIdentityTest, EveryParameterOfEveryOperatorCounts) {
  const std::string file = (folder_.path() / "a.hair").string(), other = (folder_.path() / "b.hair").string();
  std::ofstream(file) << "one";
  std::ofstream(other) << "other";
  size_t tried = 0;
  for (const SchemaInfo* schema : ValueReader<OperatorList>::blocks()) {
    for (const KeyInfo& key : schema->keys()) {
      const auto [a, b] = two_values(key, file, other);
      const auto text = [&](const std::string& value) {
        std::string keys = key.name + ": " + value;
        for (const KeyInfo& required : schema->keys())
          if (required.options.required && required.name != key.name)
            keys += ", " + required.name + ": " + two_values(required, file, other).first;
        const bool mask = schema->name() == "operator mask";
        return "- " + (mask ? "length" : schema->name()) + ": {" + keys + "}\n";
      };
      EXPECT_NE(hash_of(text(a)), hash_of(text(b))) << schema->name() << "." << key.name;
      EXPECT_EQ(hash_of(text(a)), hash_of(text(a)));
      ++tried;
    }
  }
  EXPECT_GE(tried, 40u);
}

TEST_F(GroomIdentityTest, EveryFormOfAFieldCounts) {
  std::ofstream(folder_.path() / "a.png") << "bytes";
  const std::string map = "{map: " + (folder_.path() / "a.png").string();
  const std::vector<std::string> fields{"0.5",
                                        "0.25",
                                        map + "}",
                                        map + ", channel: r}",
                                        map + ", channel: g}",
                                        map + ", channel: r, range: [0, 0.5]}",
                                        map + ", channel: r, space: linear}",
                                        map + ", channel: r, space: srgb}",
                                        "{ramp: {along: strand, knots: [[0, 0.1], [1, 0.2]]}}",
                                        "{ramp: {along: x, knots: [[0, 0.1], [1, 0.2]]}}",
                                        "{ramp: {along: strand, knots: [[0, 0.1], [1, 0.3]]}}",
                                        "{ramp: {along: strand, knots: [[0, 0.1], [0.5, 0.2]]}}",
                                        "{noise: {frequency: 1}}",
                                        "{noise: {frequency: 2}}",
                                        "{noise: {frequency: 1, amplitude: 2}}",
                                        "{noise: {frequency: 1, offset: 2}}",
                                        "{noise: {frequency: 1, seed: 2}}",
                                        "{attribute: clump}",
                                        "{attribute: random}",
                                        "{product: [0.5, {attribute: random}]}",
                                        "{product: [{attribute: random}, 0.5]}",
                                        "{product: [0.5, " + map + ", channel: r}]}",
                                        map + ", wrap: black}",
                                        map + ", projection: planar}",
                                        map + ", projection: planar, axis: x}",
                                        map + ", projection: planar, center: [0, 1, 0]}",
                                        map + ", projection: planar, size: [1, 1, 2]}",
                                        map + ", projection: sphere}",
                                        "{add: [0.5, {attribute: random}]}",
                                        "{min: [0.5, {attribute: random}]}",
                                        "{max: [0.5, {attribute: random}]}",
                                        "{mix: [0.5, 1], by: {attribute: random}}",
                                        "{invert: {attribute: random}}",
                                        "{clamp: {attribute: random}}",
                                        "{clamp: {attribute: random}, low: 0.1}",
                                        "{clamp: {attribute: random}, high: 0.9}",
                                        "{threshold: {attribute: random}}",
                                        "{threshold: {attribute: random}, at: 0.1}",
                                        "{threshold: {attribute: random}, width: 0.1}",
                                        "{step: {attribute: random}}",
                                        "{step: {attribute: random}, size: 0.1}",
                                        "{remap: {attribute: random}, knots: [[0, 0], [1, 2]]}",
                                        "{remap: {attribute: random}, knots: [[0, 0], [1, 3]]}",
                                        "{box: [1, 1, 1]}",
                                        "{box: [1, 1, 2]}",
                                        "{box: [1, 1, 1], center: [0, 0, 0]}",
                                        "{box: [1, 1, 1], soft: 1}",
                                        "{sphere: 1}",
                                        "{sphere: 2}",
                                        "{sphere: 1, center: [0, 0, 0]}",
                                        "{sphere: 1, soft: 1}",
                                        "{height: y}",
                                        "{height: x}",
                                        "{slope: y}",
                                        "{curvature: 1}",
                                        "{curvature: 2}",
                                        "{vertex_color: }",
                                        "{vertex_color: r}",
                                        "{group: ears}",
                                        "{group: nose}",
                                        "{distance: {point: [0, 0, 0]}}",
                                        "{distance: {point: [0, 0, 1]}}",
                                        "{distance: {point: [0, 0, 0], plane: y}}",
                                        "{distance: {line: [[0, 0, 0], [1, 0, 0]]}}",
                                        "{distance: {boundary: {height: y}}}",
                                        "{distance: {mesh: a.obj}}"};
  std::set<std::string> hashes;
  for (const std::string& field : fields)
    hashes.insert(to_string(hash_of("- color: {value: " + field + "}\n")));
  EXPECT_EQ(hashes.size(), fields.size());
}

TEST_F(GroomIdentityTest, EveryByteOfAFileCountsAndItsFolderDoesNot) {
  const auto file = folder_.path() / "map.png";
  const std::string bytes = "any bytes at all, as long as they differ";
  const auto hash = [&](const std::filesystem::path& path, const std::string& contents) {
    std::ofstream(path, std::ios::binary) << contents;
    return hash_of("- length: {value: {product: [2, {map: " + path.string() + ", channel: r}]}}\n");
  };
  const ContentHash right = hash(file, bytes);
  for (size_t i = 0; i < bytes.size(); ++i) {
    std::string changed = bytes;
    changed[i] ^= 1;
    EXPECT_NE(hash(file, changed), right);
  }
  std::filesystem::create_directory(folder_.path() / "elsewhere");
  EXPECT_EQ(hash(folder_.path() / "elsewhere" / "map.png", bytes), right);
  std::filesystem::remove(file);
  EXPECT_NE(hash_of("- length: {value: {product: [2, {map: " + file.string() + ", channel: r}]}}\n"), right);
}

TEST_F(GroomIdentityTest, EverythingElseOfTheGroomThatShapesStrandsCounts) {
  std::set<std::string> hashes;
  const Coat base{kEveryFrozenOperator, "", 1000, 500};
  const auto add = [&](const GroomParams& params, uint64_t seed = 7) {
    EXPECT_TRUE(hashes.insert(to_string(hash_of(params, seed))).second);
  };
  add(params_of(base));
  add(params_of(base), 8);
  Coat coat = base;
  coat.strands = 1001;
  add(params_of(coat));
  coat = base;
  coat.points = 9;
  add(params_of(coat));
  coat = base;
  coat.more = "density: {ramp: {along: y, knots: [[-1, 0], [1, 1]]}}\n";
  add(params_of(coat));
  coat.more = "density: {ramp: {along: y, knots: [[-1, 0], [1, 2]]}}\n";
  add(params_of(coat));
  // The order of the operators, and how many there are.
  coat = base;
  coat.operators = "- frizz: {}\n- curl: {}\n";
  add(params_of(coat));
  coat.operators = "- curl: {}\n- frizz: {}\n";
  add(params_of(coat));
  coat.operators = "- curl: {}\n- frizz: {}\n- frizz: {}\n";
  add(params_of(coat));
  // The skin.
  std::vector<V3f> moved = shapes::ball_cage(1.2f).positions;
  moved[3].x += 1e-6f;
  const LimitSurface other(rest_->shared_topology(), moved);
  const GroomParams params = params_of(base);
  const OperatorStack stack(params.operators);
  EXPECT_TRUE(hashes.insert(to_string(GroomIdentity(params, 7, stack, &other).whole())).second);
  ControlMesh creased = shapes::ball_cage(1.2f);
  creased.creases.push_back({0, 1, 2.0f});
  const auto sharp = shapes::surface_of(creased);
  EXPECT_TRUE(hashes.insert(to_string(GroomIdentity(params, 7, stack, sharp.get()).whole())).second);
}

TEST_F(GroomIdentityTest, WhatDoesNotMatterLeavesTheCacheFresh) {
  const std::string frozen = "- length: {value: 0.5}\n- frizz: {}\n";
  make(Coat{frozen + "- width: {root: 0.01}\n", "frizz"});
  const auto is_fresh = [&](const Coat& coat) { return make(coat)->cache_report()->fresh; };
  EXPECT_TRUE(is_fresh({frozen + "- width: {root: 0.02}\n- color: {value: 0.3}\n", "frizz"})) << "live ones";
  EXPECT_TRUE(is_fresh({frozen, "frizz", 1500, 500, 8, "role: guard\n"}));
  EXPECT_FALSE(is_fresh({frozen, "frizz", 1500, 400})) << "other leaves";
  EXPECT_FALSE(is_fresh({frozen, "frizz", 1500, 500, 8, "seed: 3\n"}));
  EXPECT_FALSE(is_fresh({frozen, "frizz", 1500, 500, 8, "", "other"})) << "a groom's name seeds it";
  const auto hash = [&](const std::string& operators) {
    return make(Coat{operators, "frizz"})->content_hash();
  };
  EXPECT_NE(hash(frozen + "- width: {root: 0.02}\n"), hash(frozen + "- width: {root: 0.03}\n"));
}

/// Replaces the manifest of a cache, and removes the strands.
void pretend(const std::filesystem::path& manifest, const std::filesystem::path& offsets,
             const std::string& text) {
  const ContentHash key = StoredFile(manifest).key();
  ContentStore::Writer writer(manifest, "manifest", key);
  writer.add(std::as_bytes(std::span(text.data(), text.size())));
  ASSERT_TRUE(writer.commit([](const std::string& line) { ADD_FAILURE() << line; }));
  std::filesystem::remove(offsets);
}

TEST_F(GroomIdentityTest, CachesOfOtherVersionsAreStaleAndNotDamaged) {
  const Coat coat{"- length: {value: 0.5}\n- frizz: {}\n", "frizz"};
  make(coat);
  ASSERT_EQ(files("manifest").size(), 1u);
  const auto manifest = files("manifest").front(), offsets = files("offsets").front();
  const std::string text = [&] {
    const StoredFile file(manifest);
    return std::string(reinterpret_cast<const char*>(file.section(0).data()), file.section(0).size());
  }();
  const auto replaced = [](std::string in, const std::string& from, const std::string& by) {
    const size_t at = in.find(from);
    EXPECT_NE(at, std::string::npos) << from << " in\n" << in;
    return in.replace(at, from.size(), by);
  };
  const auto hash_of_stage = [&](const std::string& name) {
    return text.substr(text.find("\n" + name + "\t") + name.size() + 2, 32);
  };
  // An operator of another version.
  std::string other = replaced(text, hash_of_stage("frizz"), std::string(32, '1'));
  const size_t frizz = other.find("\nfrizz\t");
  other = other.substr(0, frizz) + replaced(other.substr(frizz), "version\t1", "version\t0");
  pretend(manifest, offsets, other);
  EXPECT_EQ(make(coat)->cache_report()->summary(),
            "stale from frizz (this version of Pelage computes it differently)");
  // Another machine.
  const size_t machine = text.find("\tmachine\t") + 9;
  other = replaced(text, text.substr(5, 32), std::string(32, '1'));
  other.replace(machine, 3, "old");
  pretend(manifest, offsets, other);
  EXPECT_EQ(make(coat)->cache_report()->summary(),
            "stale from skin (the compiler, the libraries or the processor changed)");
  // A program without versions: it stated a hash of its sources.
  other = "skin\t" + std::string(32, '1') + "\n\tprogram\tabc fma\n" + text.substr(text.find("\tmesh\t"), 39);
  pretend(manifest, offsets, other);
  EXPECT_EQ(
      make(coat)->cache_report()->summary(),
      "stale from skin (this version of Pelage computes it differently, this version of Pelage computes "
      "maps and noise differently)");
  EXPECT_TRUE(warnings_.empty()) << warnings_.front();
  EXPECT_TRUE(make(coat)->cache_report()->fresh);
}

}  // namespace
}  // namespace pelage
