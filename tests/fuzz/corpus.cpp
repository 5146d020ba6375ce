// SPDX-License-Identifier: Apache-2.0
#include "tests/fuzz/corpus.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "base/file.h"
#include "base/hash.h"
#include "base/temporary_folder.h"
#include "geom/io/strand_file.h"
#include "image/exr.h"
#include "tests/geom/random_strands.h"
#include "tests/post/exr_pictures.h"

namespace pelage {
namespace {

template <class T>
void append(std::string& text, T value) {
  text.append(reinterpret_cast<const char*>(&value), sizeof value);
}

std::string strand_bytes(const char* ending) {
  const TemporaryFolder folder;
  RandomStrandOptions options;
  options.strands = 6;
  options.min_points = options.max_points = 5;
  StrandArrays a = random_strands(1, options).arrays();
  a.attributes.push_back(
      {"color", AttributeClass::kPerPoint, 3, std::vector<float>(a.points.size() / 4 * 3, 0.5f)});
  a.root_uv.resize(a.ids.size());
  const std::filesystem::path path = folder.path() / (std::string("a") + ending);
  write_strands(path, Strands(std::move(a)));
  return read_file(path);
}

std::string exr_bytes(int width, int height) {
  const TemporaryFolder folder;
  ExrImage image;
  image.width = width;
  image.height = height;
  const size_t count = static_cast<size_t>(width) * static_cast<size_t>(height);
  for (const char* name : {"B", "G", "R"}) {
    image.channels.push_back({name, ChannelType::kHalf, std::vector<float>(count, 0.5f), {}});
  }
  image.channels.push_back({"id", ChannelType::kUint, {}, std::vector<uint32_t>(count, 7)});
  image.attributes["comments"] = std::string("seed");
  write_exr(folder.path() / "a.exr", image);
  return read_file(folder.path() / "a.exr");
}

}  // namespace

void for_each_damaged(const std::string& seed, int count,
                      const std::function<void(const std::string&)>& feed) {
  for (size_t length = 0; length < std::min<size_t>(seed.size(), 200); ++length) feed(seed.substr(0, length));
  for (uint64_t i = 0; i < 60; ++i) feed(seed.substr(0, hash64(i, random_use("cut")) % seed.size()));
  for (uint64_t i = 0; i < static_cast<uint64_t>(count); ++i) {
    std::string bytes = seed;
    const uint64_t h = hash64(i, random_use("flip"));
    // Half of the damage goes to the header, where it hurts.
    const size_t within = i % 2 ? seed.size() : std::min<size_t>(seed.size(), 400);
    bytes[(h >> 8) % within] = static_cast<char>(bytes[(h >> 8) % within] ^ (1 << (h % 8)));
    feed(bytes);
  }
  const uint32_t words[] = {0,          1,          0xffffffff, 0x7fffffff, 0x80000000, 0x40000000,
                            0x7fc00000, 0x7f800000, 0xff800000, 0x7f7fffff, 65535,      1u << 24};
  for (uint64_t i = 0; i < static_cast<uint64_t>(count); ++i) {
    std::string bytes = seed;
    if (bytes.size() < 8) continue;
    const uint64_t h = hash64(i, random_use("word"));
    const size_t within = (i % 2 ? seed.size() : std::min<size_t>(seed.size(), 400)) - 4;
    std::memcpy(&bytes[(h >> 8) % within], &words[h % std::size(words)], 4);
    feed(bytes);
  }
  for (uint64_t i = 0; i < static_cast<uint64_t>(count); ++i) {
    const uint64_t h = hash64(i, random_use("move"));
    const size_t from = (h >> 4) % seed.size(), to = (h >> 24) % seed.size(), length = h % 97;
    std::string bytes = seed;
    bytes.insert(to, seed.substr(from, length));
    if (i % 2) bytes.erase(from, length);
    feed(bytes);
  }
}

std::vector<std::string> hair_corpus() {
  std::vector<std::string> corpus{strand_bytes(".hair")};
  // A few bytes that claim everything.
  for (uint32_t arrays : {2u, 3u, 31u, 0xffffffffu}) {
    for (uint32_t segments : {0u, 1u, 0xfffffffeu, 0xffffffffu}) {
      std::string bytes = "HAIR";
      for (uint32_t word : {0xffffffffu, 0xffffffffu, arrays, segments}) append(bytes, word);
      corpus.push_back(bytes.append(200, '\xff'));
    }
  }
  return corpus;
}

std::vector<std::string> tfx_corpus() {
  std::vector<std::string> corpus{strand_bytes(".tfx")};
  for (uint32_t strands : {1u, 0x10000u, 0xffffffffu}) {
    for (uint32_t offset : {160u, 161u, 0xffffffffu}) {
      std::string bytes;
      append(bytes, 4.0f);
      for (uint32_t word : {strands, 0xffffu, offset, offset, offset, offset, offset}) append(bytes, word);
      corpus.push_back(bytes.append(400, '\x41'));
    }
  }
  return corpus;
}

std::vector<std::string> request_corpus() {
  return {"rat.yaml character=rat coat=under frame=3 leaf=2-7 camera=scene memory=512M",
          "'my ''rat''.yaml' 'set=a.b={c: [1, 2]}' scale=1e-3 detail=full threads=4",
          "r leaf=0-18446744073709551615 coat=c",
          "r leaf=18446744073709551615 coat=c",
          "r scale=1e-45",
          "r memory=99999999999999999999G",
          "'" + std::string(100000, ' '),
          std::string(100000, '\'') + "r"};
}

std::vector<std::string> obj_corpus() {
  std::string cube =
      "v -1 -1 1\nv 1 -1 1\nv -1 1 1\nv 1 1 1\nv -1 1 -1\nv 1 1 -1\nv -1 -1 -1\nv 1 -1 -1\n"
      "vt 0 0\nvt 1 0\nvt 0 1\nvt 1 1\ng top\nf 1/1 2/2 4/4 3/3\nf 3/1 4/2 6/4 5/3\nf 5/1 6/2 8/4 7/3\n"
      "g rest\nf 7/1 8/2 2/4 1/3\nf 2/1 8/2 6/4 4/3\nf 7/1 1/2 3/4 5/3\n"
      "t crease 2/1/0 0 1 2.5\nt corner 1/1/0 5 3.0\nt hole 1/0/0 2\n";
  std::vector<std::string> corpus{cube};
  std::string polygon, vertices;
  for (int i = 1; i <= 300; ++i) {
    vertices += "v " + std::to_string(std::cos(i / 50.0)) + " " + std::to_string(std::sin(i / 50.0)) + " 0\n";
    polygon += " " + std::to_string(i);
  }
  corpus.push_back(vertices + "f" + polygon + "\n");
  corpus.push_back("v 0 0 0\nv 1 0 0\nv 0 1 0\nf -9 -2 -1\n");
  corpus.push_back("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4294967297\n");
  corpus.push_back("v nan inf -inf\nv 1e999 0 0\nv 0 1e-999 0\nf 1 2 3\n");
  corpus.push_back("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 1 1\nf 1 2 1 2\nf 1 2 3\nf 1 2 3\nf 3 2 1\n");
  corpus.push_back("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nt crease 99999999/1/0\nt hole -1/0/0 5\nt\n");
  corpus.push_back("f" + std::string(100000, ' ') + "\n");
  corpus.push_back(std::string(100000, 'v'));
  corpus.push_back("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1/2/3/4 2//3/ /3\n");
  return corpus;
}

std::vector<std::string> hdr_corpus() {
  const auto header = [](const std::string& size) {
    return "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n" + size + "\n";
  };
  std::string flat = header("-Y 4 +X 4");
  for (int i = 0; i < 64; ++i) flat += static_cast<char>(i % 4 == 3 ? 128 : 40 + i);
  std::string runs = header("-Y 3 +X 16");
  for (int y = 0; y < 3; ++y) {
    runs += std::string("\2\2\0\20", 4);
    for (int c = 0; c < 4; ++c) runs += std::string("\210\x80\x08", 3) + "abcdefgh";
  }
  std::vector<std::string> corpus{flat, runs};
  for (const char* size : {"-Y 65536 +X 65536", "-Y 2147483647 +X 2147483647", "-Y -4 +X 4", "+X 4 -Y 4",
                           "-Y 0 +X 0", "-Y 99999999999999999999 +X 1", "-Y 30000 +X 32767", ""}) {
    corpus.push_back(header(size) + std::string(100, '\2'));
  }
  // Runs of whole pixels, as old files have them: three, and more than the row has.
  corpus.push_back(header("-Y 1 +X 4") + "\5\6\7\x80\1\1\1\3");
  corpus.push_back(header("-Y 2 +X 65535") + std::string(2, '\5') + std::string(20, '\1'));
  corpus.push_back("#?RADIANCE\n" + std::string(100000, 'x'));
  corpus.push_back("#?RADIANCE\nEXPOSURE=nan\nGAMMA=0\n" + flat.substr(11));
  return corpus;
}

std::vector<std::string> exr_corpus() { return {exr_bytes(5, 40), exr_bytes(1, 1)}; }

std::vector<std::string> ies_corpus() {
  const std::string head = "IESNA:LM-63-1995\n[TEST] seed\n", tail = " 1 2 0.1 0.1 0\n1 1 50\n";
  const std::string tilt = head + "TILT=INCLUDE\n1\n2\n0 90\n1 0.9\n1 1000 1.5 3 3" + tail;
  std::vector<std::string> corpus{
      tilt + "0 45 90\n0 45 90\n100 50 10\n100 60 20\n100 70 30\n",
      head + "TILT=NONE\n1 1000 1 2 4" + tail + "0 90 0 90 180 270 8 1 8 2 8 3 8 4",
      head + "TILT=NONE\n1 1000 1 4 1" + tail + "0 0.01 0.02 180 0 1e-38 1e-45 0 3e38",
      head + "TILT=NONE\n1 1000 1 2 1" + tail + "0 0.01 0 1 0",
      head + "TILT=NONE\n1 1000 3e38 2 1" + tail + "0 180 0 1e38 1e38"};
  for (const char* sizes : {"99999999 1", "1e30 1e30", "nan inf", "-1 2", "4294967297 2", "2 2"})
    corpus.push_back(head + "TILT=NONE\n1 1000 1 " + sizes + tail + "0 90 0 1 1");
  corpus.push_back(head + "TILT=INCLUDE\n1 99999999999 " + std::string(100000, '1'));
  corpus.push_back("TILT=" + std::string(100000, '\n'));
  corpus.push_back(std::string(100000, ' ') + "TILT=NONE");
  return corpus;
}

std::vector<std::string> post_corpus() {
  // One part, and the same channels in two parts with windows of their own.
  const TemporaryFolder folder;
  ExrImage image = still_image(9, 20);
  for (float& u : pixels_of(image, "forward.u")) u = 3.3f;
  write_exr(folder.path() / "one.exr", image);
  const PixelBox box{2, 3, 11, 23};
  write_parts(
      folder.path() / "two.exr", folder.path() / "one.exr", {0, 0, 12, 24},
      {{"rgb",
        box,
        {{"A", ChannelType::kHalf}, {"R", ChannelType::kHalf}},
        {image.find("A")->pixels, image.find("R")->pixels},
        "left"},
       {"data",
        box,
        {{"Z", ChannelType::kFloat}, {"forward.u", ChannelType::kFloat}, {"forward.v", ChannelType::kFloat}},
        {image.find("Z")->pixels, image.find("forward.u")->pixels, image.find("forward.v")->pixels},
        "left"}});
  // A few pixels in a huge frame, with vectors, depths and colours beyond all sense.
  ExrImage wild = still_image(9, 6);
  for (size_t i = 0; i < 9 * 6; ++i) {
    pixels_of(wild, "forward.u")[i] = i % 2 ? 1e30f : -3e38f;
    pixels_of(wild, "key.diffuse.R")[i] = i % 3 ? 3e38f : -3e38f;
    pixels_of(wild, "Z")[i] = i % 5 ? 1e-40f : 3e38f;
  }
  const PixelBox few{30000, 20000, 30009, 20006};
  write_parts(folder.path() / "wild.exr", folder.path() / "one.exr", {0, 0, 65000, 65000},
              {{"",
                few,
                {{"A", ChannelType::kHalf},
                 {"R", ChannelType::kFloat},
                 {"Z", ChannelType::kFloat},
                 {"forward.u", ChannelType::kFloat},
                 {"forward.v", ChannelType::kFloat}},
                {wild.find("A")->pixels, wild.find("key.diffuse.R")->pixels, wild.find("Z")->pixels,
                 wild.find("forward.u")->pixels, wild.find("forward.v")->pixels},
                ""}});
  return {read_file(folder.path() / "one.exr"), read_file(folder.path() / "two.exr"),
          read_file(folder.path() / "wild.exr")};
}

std::vector<std::string> scene_corpus() {
  const std::filesystem::path examples = std::filesystem::path(PELAGE_SOURCE_DIR) / "examples";
  std::vector<std::string> corpus;
  for (const char* name : {"tuft.yaml", "rat.yaml", "imported.yaml"})
    corpus.push_back(read_file(examples / name));
  // What the schemas take for numbers, fields, keys and names, all of it wrong.
  corpus.push_back(
      "pelage: 1\nframes: 1-999999999x0\ncamera: {fov: {keys: {1: 1e999, x: 2, 1.0: 3}}, lens: {f_stop: "
      "-0}}\n"
      "image: {width: 99999999999999999999, height: -1}\nrender: {memory: -4G, samples: 1e300, bounces: "
      "0x7}\n"
      "grooms: {g: {strands: .nan, density: {product: [{product: []}, {ramp: {along: w, knots: [[1, 0], [0, "
      "1]]}},"
      " {noise: {frequency: []}}, {map: \"\", range: [1]}, {attribute: }]}, operators: [clump, {}, {a: 1, b: "
      "2},"
      " {curl: }, {curl: {turns: [1]}}, 5, [length]]}}\ncharacters: {c: {parts: [{skin: g, grooms: [g]}, "
      "5]}}\n"
      "lights: {l: {type: [sphere]}, m: {}, n: sphere}\nmaterials: {m: {model: cone-shell, color: [1, "
      "2]}}\n");
  std::string bomb = "a0: &a0 [x, x, x, x, x, x, x, x, x]\n";
  for (int i = 1; i < 12; ++i) {
    const std::string last = "*a" + std::to_string(i - 1);
    bomb += "a" + std::to_string(i) + ": &a" + std::to_string(i) + " [" + last + ", " + last + ", " + last +
            "]\n";
  }
  corpus.push_back(bomb);
  corpus.push_back("a: &a [*a, *a]\n");
  for (const char* piece :
       {"[", "{a: ", "[ #]\n", "- ", "? ", "&a ", "!", "a: 1\n", "---\n", "a:", "\"", "%"}) {
    std::string text = "pelage: ";
    while (text.size() < 20000) text += piece;
    corpus.push_back(text);
  }
  return corpus;
}

}  // namespace pelage
