// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <string_view>

#include "rib/host/hair_session.h"

namespace pelage {

class HairOutput;

/// A part of a coat that a procedural stands for: a range of leaves.
struct HairNode {
  std::shared_ptr<const HairSession> session;
  std::shared_ptr<const HairFrame> frame;
  std::shared_ptr<const CoatTree> tree;
  HairArguments arguments;  ///< that stand for the same node

  /// Outputs smaller nodes or, for a single leaf, its strands.
  void subdivide(HairOutput& output) const;
};

/// Receives what a procedural is divided into.
class HairOutput {
 public:
  virtual ~HairOutput() = default;
  /// `bound`: the exact box of all strands of the node.
  virtual void nested(HairNode node, const Box3f& bound) = 0;
  /// `times`: one per motion key, in frames relative to the frame.
  virtual void strands(Strands strands, std::span<const float> times) = 0;
};

/// Divides the procedural that `arguments` (see HairArguments) stand for.
///
/// `detail`: the area of the procedural's bound in the picture, in square pixels; 1e38 or larger for all
/// strands. Unless the arguments determine the level of detail, and if `render.lod` is enabled, the size of a
/// scene unit in the picture is taken to be sqrt(detail / A), where A is the mean area of the projections of
/// the exact box of the full coat. It is the same for all strands of the request, and for all nodes into
/// which the request is divided. So neither the tightness of the bound nor the division into leaves affects
/// it.
///
/// Throws Error: kArguments for unknown names, and the errors of HairSession.
void subdivide_request(HairSessions& sessions, std::string_view arguments, float detail, HairOutput& output);

}  // namespace pelage
