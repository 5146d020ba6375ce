// SPDX-License-Identifier: Apache-2.0
#include "rib/host/hair_node.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/nearest_name.h"

namespace pelage {
namespace {

constexpr float kInfiniteDetail = 1e37f;  // RI_INFINITY is 1e38
constexpr float kMinPixelsPerUnit = 1e-9f;

/// Mean area of the projections of a box to planes of all directions: a quarter of its surface.
float mean_projection(const Box3f& box) {
  if (box.isEmpty()) return 0;
  const V3f size = box.size();
  return 0.5f * (size.x * size.y + size.y * size.z + size.z * size.x);
}

/// Indices of the coats of a request.
std::vector<size_t> chosen_coats(const HairFrame& frame, const HairArguments& arguments) {
  std::vector<size_t> chosen;
  std::vector<std::string> names;
  for (size_t i = 0; i < frame.coats().size(); ++i) {
    const std::string& name = frame.coats()[i].groom;
    if (arguments.coat.empty() || name == arguments.coat) chosen.push_back(i);
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  }
  if (chosen.empty() && !arguments.coat.empty()) {
    throw Error(ErrorKind::kArguments,
                "procedural: there is no coat " + quote(arguments.coat) + suggest(arguments.coat, names));
  }
  return chosen;
}

LeafRange leaves_of(const HairArguments& arguments, const CoatTree& tree) {
  if (!arguments.leaves) return tree.all();
  if (arguments.leaves->end > tree.all().end) {
    throw Error(ErrorKind::kArguments,
                fmt::format("procedural: there is no leaf {}; the coat '{}' has the leaves 0 to {}",
                            arguments.leaves->end - 1, arguments.coat, tree.all().end - 1));
  }
  return *arguments.leaves;
}

/// The request, as far as it concerns one coat.
struct Request {
  std::shared_ptr<const HairSession> session;
  std::shared_ptr<const HairFrame> frame;
  HairArguments arguments;
};

HairDetail detail_of(const Request& request, const std::vector<size_t>& coats, float detail) {
  const HairArguments& arguments = request.arguments;
  using Kind = HairDetail::Kind;
  if (arguments.full_detail || !request.session->scene().render.lod.enabled) return {};
  if (arguments.scene_camera) return {Kind::kSceneCamera, 0};
  if (arguments.pixels_per_unit) return {Kind::kScale, *arguments.pixels_per_unit};
  if (!(detail < kInfiniteDetail)) return {};
  Box3f box;
  for (const size_t coat : coats) {
    const auto full = request.session->tree(*request.frame, coat, {});
    box.extendBy(request.session->box(*full, leaves_of(arguments, *full)));
  }
  const float area = mean_projection(box);
  if (!(area > 0)) return {};
  return {Kind::kScale, std::max(kMinPixelsPerUnit, std::sqrt(std::max(0.0f, detail) / area))};
}

}  // namespace

void HairNode::subdivide(HairOutput& output) const {
  const LeafRange leaves = *arguments.leaves;
  if (leaves.count() == 1) {
    Strands strands = session->grow(*tree, leaves.first);
    const std::vector<float> times = motion_times(session->scene().camera, strands.motion_keys());
    output.strands(std::move(strands), times);
    return;
  }
  for (const LeafRange part : tree->split(leaves)) {
    const Box3f box = session->box(*tree, part);
    if (box.isEmpty()) continue;
    HairNode node = *this;
    node.arguments.leaves = part;
    output.nested(std::move(node), box);
  }
}

void subdivide_request(HairSessions& sessions, std::string_view text, float detail, HairOutput& output) {
  Request request;
  request.arguments = parse_hair_arguments(text);
  request.session = sessions.of(request.arguments);
  const int frame = request.arguments.frame.value_or(request.session->scene().frames.frames.front());
  request.arguments.frame = frame;
  request.frame = request.session->frame(frame, request.arguments.character);
  const std::vector<size_t> coats = chosen_coats(*request.frame, request.arguments);
  const HairDetail level = detail_of(request, coats, detail);
  for (const size_t coat : coats) {
    HairNode node{request.session, request.frame, request.session->tree(*request.frame, coat, level),
                  request.arguments};
    node.arguments.character = request.frame->coats()[coat].character;
    node.arguments.coat = request.frame->coats()[coat].groom;
    node.arguments.leaves = leaves_of(request.arguments, *node.tree);
    node.arguments.full_detail = level.kind == HairDetail::Kind::kFull;
    node.arguments.scene_camera = level.kind == HairDetail::Kind::kSceneCamera;
    node.arguments.pixels_per_unit.reset();
    if (level.kind == HairDetail::Kind::kScale) node.arguments.pixels_per_unit = level.pixels_per_unit;
    if (node.arguments.leaves->count() > 0) node.subdivide(output);
  }
}

}  // namespace pelage
