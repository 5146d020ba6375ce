// SPDX-License-Identifier: Apache-2.0
#include "groom/operators/avoid.h"

#include <algorithm>
#include <limits>

#include "base/job.h"
#include "base/ledger.h"
#include "geom/closest_point.h"
#include "groom/operators/pushed_strand.h"
#include "groom/strands/named_mesh.h"
#include "groom/strands/strand_fields.h"

namespace pelage {

struct Avoid::Obstacle {
  Obstacle(SkinMesh triangles, const Job& job)
      : mesh(std::move(triangles)),
        tree(mesh, 0, &job),
        charge(job.ledger, MemoryTag::kGrooms, static_cast<int64_t>(mesh.bytes() + tree.bytes())) {
    for (size_t v = 0; v < mesh.vertex_count(); ++v) box.extendBy(mesh.position(v));
  }
  SkinMesh mesh;
  ClosestPointTree tree;
  Box3f box;
  MemoryCharge charge;
};

const Schema<AvoidParams>& AvoidParams::schema() {
  static const Schema<AvoidParams> table = [] {
    Schema<AvoidParams> s(
        "avoid",
        "Keeps strands out of another mesh, such as a collar or a saddle. A strand that "
        "cannot be moved out ends where it would enter. A strand whose root is inside keeps a thousandth of "
        "its length.");
    s.set_example(R"(grooms:
  coat:
    skin: patch
    strands: 20000
    operators:
      - avoid: {mesh: block.obj, offset: 0.05})");
    s.set_picture("Left: straight strands. Right: kept out of a block above the skin.");
    s.key(
        "mesh", &AvoidParams::mesh,
        {.help = "OBJ file of a closed mesh, in the rest space of the skin. Its faces are flat, and it moves "
                 "with the skin",
         .required = true});
    s.key("offset", &AvoidParams::offset,
          {.unit = "scene units",
           .help = "Minimum distance between strands and mesh, except near the roots",
           .min = 0,
           .max = 1e9});
    s.key("iterations", &AvoidParams::iterations, {.help = "Maximum number of passes", .min = 1, .max = 64});
    return s;
  }();
  return table;
}

void Avoid::prepare(const PrepareContext& context) {
  if (!context.rest)
    throw Error(ErrorKind::kInput, context.position, "the operator avoid needs strands that grow on a skin");
  obstacle_ = std::make_shared<const Obstacle>(read_named_mesh(params_.mesh, context.job), context.job);
  params_.offset = params_.offset.with_textures(context.textures);
}

void Avoid::apply(StrandBatch& batch) const {
  StrandRow offset, length;
  evaluate(params_.offset, batch, 0, offset);
  arc_lengths(batch, length);
  for (size_t s = 0; s < batch.count; ++s) {
    const float distance = std::max(offset[s], 0.0f), reach = length[s] / batch.scale + distance;
    const V3f root = vector_at(batch.rest.position, s);
    const Box3f& box = obstacle_->box;
    const V3f nearest(std::clamp(root.x, box.min.x, box.max.x), std::clamp(root.y, box.min.y, box.max.y),
                      std::clamp(root.z, box.min.z, box.max.z));
    ClosestPoint at_root;
    if ((nearest - root).length() > reach ||
        !obstacle_->tree.closest(root, std::numeric_limits<float>::infinity(), at_root) ||
        (!at_root.inside && at_root.distance > reach)) {
      continue;
    }
    PushedStrand strand(obstacle_->tree, root, vector_at(batch.rest.normal, s),
                        at_root.inside ? at_root.distance : 0.0f);
    for (int p = 0; p < batch.point_count(); ++p) strand.add(batch.to_rest(s, batch.offset(p, s)));
    if (strand.is_clear(distance)) continue;
    strand.push_out(distance, params_.iterations, vector_at(batch.rest.tangent, s));
    for (int p = 1; p < batch.point_count(); ++p)
      batch.set_offset(p, s, batch.from_rest(s, strand.offset(p)) * batch.scale);
  }
}

StrandReach Avoid::reach_after(const StrandReach& before) const { return PushedStrand::reach_after(before); }

}  // namespace pelage
