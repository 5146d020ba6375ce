// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <limits>

#include "base/file.h"
#include "base/visible_text.h"
#include "geom/usd/usd_layer.h"
#include "geom/usd/usda_scanner.h"

namespace pelage {
namespace {

constexpr int kMaxPrimDepth = 64;
constexpr size_t kMaxItems = 1'000'000;

bool is_list_word(std::string_view word) {
  return word == "prepend" || word == "append" || word == "add" || word == "delete" || word == "reorder";
}

}  // namespace

/// Parses the statements of a layer.
class UsdaParser {
 public:
  explicit UsdaParser(UsdLayer& layer) : layer_(layer), in_(layer, 0, layer.text().size()) {}

  void parse() {
    if (in_.next() == '(') layer_metadata();
    while (in_.next() != 0) {
      if (in_.accept(';')) continue;
      const size_t place = in_.place();
      const std::string_view word = in_.name();
      if (word == "def" || word == "over" || word == "class") {
        prim(word, layer_.root_, 1);
      } else if (word == "reorder") {
        in_.name();
        in_.expect('=');
        in_.skip_value();
      } else {
        layer_.fail(place, "expected 'def', 'over' or 'class'");
      }
    }
  }

 private:
  void layer_metadata() {
    in_.expect('(');
    while (!in_.accept(')')) {
      if (in_.accept(';') || skip_comment_text()) continue;
      std::string_view key = in_.name();
      if (is_list_word(key)) key = in_.name();
      in_.expect('=');
      if (key == "defaultPrim") {
        layer_.default_prim_ = in_.quoted();
      } else if (key == "upAxis") {
        layer_.z_up_ = in_.quoted() == "Z";
      } else if (key == "metersPerUnit") {
        layer_.meters_per_unit_ = in_.number();
      } else if (key == "subLayers") {
        arcs(layer_.sublayers_);
      } else {
        in_.skip_value();
      }
    }
  }

  bool skip_comment_text() {
    const char c = in_.next();
    if (c == 0) in_.fail_expected("')'");
    if (c != '"' && c != '\'') return false;
    in_.quoted();
    return true;
  }

  void count() {
    if (++items_ > kMaxItems) in_.fail("the file has more than 1,000,000 prims and attributes");
  }

  void prim(std::string_view specifier, UsdPrimSpec& parent, int depth) {
    if (depth > kMaxPrimDepth) in_.fail("prims are nested deeper than 64 levels");
    count();
    UsdPrimSpec spec;
    spec.specifier = specifier;
    if (in_.at_name()) spec.type = in_.name();
    in_.next();
    spec.place = in_.place();
    spec.name = in_.quoted();
    body(spec, depth);
    const auto [known, is_new] = parent.child_index.try_emplace(spec.name, parent.children.size());
    if (!is_new) layer_.fail(spec.place, "the prim \"" + visible(spec.name) + "\" exists already");
    parent.children.push_back(std::move(spec));
  }

  /// Metadata and statements of a prim or variant.
  void body(UsdPrimSpec& spec, int depth) {
    if (in_.next() == '(') prim_metadata(spec);
    in_.expect('{');
    while (!in_.accept('}')) {
      if (in_.accept(';')) continue;
      const std::string_view word = in_.name();
      if (word == "def" || word == "over" || word == "class") {
        prim(word, spec, depth + 1);
      } else if (word == "variantSet") {
        variant_set(spec, depth);
      } else if (word == "reorder") {
        in_.name();
        in_.expect('=');
        in_.skip_value();
      } else {
        property(word, spec);
      }
    }
  }

  void prim_metadata(UsdPrimSpec& spec) {
    in_.expect('(');
    while (!in_.accept(')')) {
      if (in_.accept(';') || in_.accept(',') || skip_comment_text()) continue;
      std::string_view key = in_.name(), list;
      if (is_list_word(key)) list = std::exchange(key, in_.name());
      in_.expect('=');
      if (list == "delete" || list == "reorder") {
        in_.skip_value();
      } else if (key == "references") {
        arcs(spec.references);
      } else if (key == "payload" || key == "payloads") {
        arcs(spec.payloads);
      } else if (key == "inherits" || key == "specializes") {
        std::vector<UsdArc> paths;
        arcs(paths);
        std::vector<std::string>& to = key == "inherits" ? spec.inherits : spec.specializes;
        for (UsdArc& arc : paths) to.push_back(std::move(arc.path));
      } else if (key == "variants") {
        selections(spec);
      } else if (key == "active") {
        const std::string_view value = layer_.text(in_.skip_value());
        spec.active = value != "false" && value != "0" && value != "False";
        spec.has_active = true;
      } else {
        in_.skip_value();
      }
    }
  }

  void selections(UsdPrimSpec& spec) {
    in_.expect('{');
    while (!in_.accept('}')) {
      if (in_.accept(';') || in_.accept(',')) continue;
      in_.name();  // its type, string
      const std::string set = in_.next() == '"' ? in_.quoted() : std::string(in_.name());
      in_.expect('=');
      spec.selections[set] = in_.quoted();
    }
  }

  void variant_set(UsdPrimSpec& spec, int depth) {
    std::vector<UsdPrimSpec>& variants = spec.variant_sets[in_.quoted()];
    in_.expect('=');
    in_.expect('{');
    while (!in_.accept('}')) {
      if (in_.accept(';')) continue;
      if (depth + 1 > kMaxPrimDepth) in_.fail("prims are nested deeper than 64 levels");
      count();
      UsdPrimSpec variant;
      variant.specifier = "over";
      in_.next();
      variant.place = in_.place();
      variant.name = in_.quoted();
      body(variant, depth + 1);
      variants.push_back(std::move(variant));
    }
  }

  /// One reference or a list of them; or None.
  void arcs(std::vector<UsdArc>& out) {
    if (!in_.accept('[')) return arc(out);
    while (!in_.accept(']')) {
      if (in_.accept(',') || in_.accept(';')) continue;
      arc(out);
    }
  }

  void arc(std::vector<UsdArc>& out) {
    if (in_.at_name()) {
      if (in_.name() != "None") in_.fail("expected a file or a path");
      return;
    }
    UsdArc arc;
    count();
    const char c = in_.next();
    arc.place = in_.place();
    if (c == '@') arc.asset = in_.asset();
    if (in_.next() == '<') arc.path = in_.path();
    if (c != '@' && c != '<') in_.fail_expected("a file or a path");
    if (in_.next() == '(') in_.skip_value();  // offsets of time
    out.push_back(std::move(arc));
  }

  void property(std::string_view word, UsdPrimSpec& spec) {
    while (word == "custom" || word == "uniform" || word == "varying" || word == "config" ||
           is_list_word(word))
      word = in_.name();
    const bool relationship = word == "rel";
    bool is_array = false;
    if (!relationship && in_.accept('[')) {
      in_.expect(']');
      is_array = true;
    }
    in_.next();
    const size_t place = in_.place();
    const std::string name(in_.name());
    std::string_view part;
    if (in_.accept('.')) part = in_.name();
    if (relationship || part == "connect") {
      if (in_.accept('=')) in_.skip_value();
      if (in_.next() == '(') in_.skip_value();
      return;
    }
    count();
    const auto [known, is_new] = spec.attribute_index.try_emplace(name, spec.attributes.size());
    if (is_new) spec.attributes.emplace_back();
    UsdAttribute& attribute = spec.attributes[known->second];
    attribute.type = word;
    attribute.is_array = is_array;
    attribute.name = name;
    attribute.place = place;
    if (in_.accept('=')) {
      if (part == "timeSamples") {
        time_samples(attribute);
      } else {
        attribute.value = value();
      }
    }
    if (in_.next() == '(') attribute_metadata(attribute);
  }

  /// The text of a value; empty for None.
  UsdText value() {
    const UsdText text = in_.skip_value();
    return layer_.text(text) == "None" ? UsdText() : text;
  }

  void time_samples(UsdAttribute& attribute) {
    in_.expect('{');
    while (!in_.accept('}')) {
      if (in_.accept(',') || in_.accept(';')) continue;
      count();
      const double time = in_.number();
      in_.expect(':');
      attribute.times.emplace_back(time, value());
    }
  }

  void attribute_metadata(UsdAttribute& attribute) {
    in_.expect('(');
    while (!in_.accept(')')) {
      if (in_.accept(';') || in_.accept(',') || skip_comment_text()) continue;
      std::string_view key = in_.name();
      if (is_list_word(key)) key = in_.name();
      in_.expect('=');
      if (key == "interpolation") {
        attribute.interpolation = in_.quoted();
      } else if (key == "elementSize") {
        attribute.element_size = static_cast<int>(std::clamp(in_.number(), 0.0, 1e6));
      } else {
        in_.skip_value();
      }
    }
  }

  UsdLayer& layer_;
  UsdaScanner in_;
  size_t items_ = 0;
};

UsdLayer::UsdLayer(const std::filesystem::path& path)
    : path_(path), contents_(read_file(path, std::numeric_limits<size_t>::max())), text_(contents_) {
  parse();
}

UsdLayer::UsdLayer(const std::filesystem::path& path, std::string_view text) : path_(path), text_(text) {
  parse();
}

void UsdLayer::parse() {
  const std::string name = path_.string();
  const auto refuse = [&](const std::string& why) { throw Error(ErrorKind::kInput, {name, 0, 0}, why); };
  if (text_.starts_with("PXR-USDC"))
    refuse("is a binary USD file; convert it with: usdcat FILE.usdc -o FILE.usda");
  if (text_.starts_with("PK\x03\x04"))
    refuse("is a USD package; unpack it and convert its files with: usdcat FILE.usdc -o FILE.usda");
  if (const std::string_view foreign = foreign_text(text_.substr(0, 64)); !foreign.empty())
    refuse(std::string(foreign));
  if (text_.starts_with(kUtf8Mark)) text_.remove_prefix(kUtf8Mark.size());
  if (!text_.starts_with("#usda ")) fail(0, "expected '#usda 1.0' at the beginning of the file");
  UsdaParser(*this).parse();
}

}  // namespace pelage
