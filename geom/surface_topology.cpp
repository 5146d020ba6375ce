// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <bit>

#include <fmt/format.h>
#include <opensubdiv/far/patchTableFactory.h>
#include <opensubdiv/far/stencilTableFactory.h>
#include <opensubdiv/far/topologyRefiner.h>

#include "base/error.h"
#include "base/job.h"
#include "geom/cage_refiner.h"
#include "geom/flat_topology.h"
#include "geom/manifold.h"
#include "geom/surface_levels.h"
#include "geom/surface_topology_impl.h"

namespace pelage {

namespace {

template <class T>
size_t topology_bytes(const std::vector<T>& values) {
  return values.capacity() * sizeof(T);
}

ContentHash hash_cage(const ControlMesh& mesh, SubdivisionScheme scheme, BoundaryRule boundary) {
  ContentHasher hasher;
  const auto add = [&](const auto& values) { hasher.add_bytes(std::as_bytes(std::span(values))); };
  const auto word = [&](size_t value) { hasher.add(static_cast<uint32_t>(value)); };
  const auto list = [&](const std::vector<uint32_t>& values) {
    word(values.size());
    add(values);
  };
  word(static_cast<size_t>(scheme));
  word(static_cast<size_t>(boundary));
  word(mesh.chaikin_creases);
  word(mesh.smooth_triangles);
  word(mesh.positions.size());
  list(mesh.face_sizes);
  list(mesh.face_vertices);
  list(mesh.face_uv);
  list(mesh.holes);
  word(mesh.uv.size());
  add(mesh.uv);
  word(mesh.creases.size());
  add(mesh.creases);
  add(mesh.corners);
  return hasher.digest();
}

CageConnectivity connect_cage(const Far::TopologyRefiner& refiner, SubdivisionScheme scheme) {
  const bool triangular = scheme == SubdivisionScheme::kLoop,
             faceted = scheme == SubdivisionScheme::kBilinear;
  const Far::TopologyLevel& base = refiner.GetLevel(0);
  CageConnectivity cage;
  cage.first_corner.push_back(0);
  cage.first_ptex.push_back(0);
  for (int f = 0; f < base.GetNumFaces(); ++f) {
    const Far::ConstIndexArray vertices = base.GetFaceVertices(f);
    const Far::ConstIndexArray edges = base.GetFaceEdges(f);
    cage.corner_vertex.insert(cage.corner_vertex.end(), vertices.begin(), vertices.end());
    cage.corner_edge.insert(cage.corner_edge.end(), edges.begin(), edges.end());
    cage.first_corner.push_back(static_cast<uint32_t>(cage.corner_vertex.size()));
    const bool whole = triangular || vertices.size() == 4;
    cage.first_ptex.push_back(cage.first_ptex.back() + (whole ? 1u : static_cast<uint32_t>(vertices.size())));
  }
  cage.vertex_split.resize(static_cast<size_t>(base.GetNumVertices()));
  for (int v = 0; v < base.GetNumVertices(); ++v) {
    cage.vertex_split[static_cast<size_t>(v)] =
        faceted || base.IsVertexNonManifold(v) ||
        base.GetVertexSharpness(v) >= OpenSubdiv::Sdc::Crease::SHARPNESS_INFINITE;
  }
  for (int e = 0; e < base.GetNumEdges(); ++e) {
    const Far::ConstIndexArray ends = base.GetEdgeVertices(e);
    const bool split = base.GetEdgeFaces(e).size() > 1 &&
                       (faceted || base.IsEdgeNonManifold(e) ||
                        base.GetEdgeSharpness(e) >= OpenSubdiv::Sdc::Crease::SHARPNESS_INFINITE);
    for (int end = 0; end < 2; ++end) {
      cage.edge_vertices.push_back(static_cast<uint32_t>(ends[end]));
      if (split) cage.vertex_split[static_cast<size_t>(ends[end])] = 1;
    }
    cage.edge_split.push_back(split);
  }
  return cage;
}

/// The ptex face of `face` that contains the half of its edge `i` next to corner `corner` (i or i + 1).
uint32_t ptex_at_corner(const CageConnectivity& cage, uint32_t face, uint32_t corner) {
  const uint32_t first = cage.first_ptex[face];
  return cage.first_ptex[face + 1] - first == 1 ? first : first + corner;
}

/// Ptex face on the other side of edge `i` of cage face `face`, at the end with its corner `near`; or -1.
int neighbour_across(const Far::TopologyLevel& base, const CageConnectivity& cage, uint32_t face, uint32_t i,
                     uint32_t near) {
  const auto edge = static_cast<int>(cage.corner_edge[cage.first_corner[face] + i]);
  const Far::ConstIndexArray faces = base.GetEdgeFaces(edge);
  if (faces.size() != 2) return -1;
  const auto other = static_cast<uint32_t>(faces[0] == static_cast<int>(face) ? faces[1] : faces[0]);
  const uint32_t vertex = cage.corner_vertex[cage.first_corner[face] + near];
  for (uint32_t c = 0; c < cage.face_size(other); ++c) {
    if (cage.corner_vertex[cage.first_corner[other] + c] == vertex) {
      return static_cast<int>(ptex_at_corner(cage, other, c));
    }
  }
  return -1;
}

void fill_ptex_faces(SurfaceTopology::Impl& impl, const Far::TopologyLevel& base, const ControlMesh& mesh) {
  const CageConnectivity& cage = impl.cage;
  for (uint32_t face = 0; face < cage.face_count(); ++face) {
    const uint32_t n = cage.face_size(face);
    const uint32_t first = cage.first_ptex[face];
    const bool whole = cage.first_ptex[face + 1] - first == 1;
    impl.cage_face.insert(impl.cage_face.end(), whole ? 1 : n, face);
    impl.part.insert(impl.part.end(), whole ? 1 : n, whole ? 0 : 1);
    if (whole) {
      for (uint32_t i = 0; i < n; ++i) impl.neighbours.push_back(neighbour_across(base, cage, face, i, i));
    } else {
      for (uint32_t i = 0; i < n; ++i) {
        const uint32_t before = (i + n - 1) % n;
        const int next = static_cast<int>(first + (i + 1) % n), previous = static_cast<int>(first + before);
        impl.neighbours.insert(impl.neighbours.end(),
                               {neighbour_across(base, cage, face, i, i), next, previous,
                                neighbour_across(base, cage, face, before, i)});
      }
    }
    if (mesh.face_uv.empty()) continue;
    const uint32_t* corners = &mesh.face_uv[cage.first_corner[face]];
    if (whole) {
      for (uint32_t i = 0; i < n; ++i) impl.uv.push_back(mesh.uv[corners[i]]);
      continue;
    }
    V2f middle(0);
    for (uint32_t i = 0; i < n; ++i) middle += mesh.uv[corners[i]] / static_cast<float>(n);
    for (uint32_t i = 0; i < n; ++i) {
      const V2f& here = mesh.uv[corners[i]];
      const V2f after = 0.5f * (here + mesh.uv[corners[(i + 1) % n]]);
      const V2f before = 0.5f * (here + mesh.uv[corners[(i + n - 1) % n]]);
      impl.uv.insert(impl.uv.end(), {here, after, middle, before});
    }
  }
  impl.hole.resize(impl.cage_face.size());
  for (uint32_t hole : mesh.holes) {
    std::fill(impl.hole.begin() + cage.first_ptex[hole], impl.hole.begin() + cage.first_ptex[hole + 1],
              uint8_t(1));
  }
}

/// Lists the patches of each ptex face.
void sort_patches(SurfaceTopology::Impl& impl) {
  const Far::PatchTable& patches = *impl.patches;
  const auto visit = [&](const auto& patch) {
    int absolute = 0;
    for (int array = 0; array < patches.GetNumPatchArrays(); ++array) {
      const int size = patches.GetPatchArrayDescriptor(array).GetNumControlVertices();
      for (int i = 0; i < patches.GetNumPatches(array); ++i, ++absolute) {
        Far::PatchTable::PatchHandle handle;
        handle.arrayIndex = array;
        handle.patchIndex = absolute;
        handle.vertIndex = i * size;
        patch(static_cast<size_t>(patches.GetPatchParam(handle).GetFaceId()), handle);
      }
    }
  };
  impl.first_patch.assign(impl.cage_face.size() + 1, 0);
  visit([&](size_t face, const auto&) { ++impl.first_patch[face + 1]; });
  for (size_t face = 0; face < impl.cage_face.size(); ++face)
    impl.first_patch[face + 1] += impl.first_patch[face];
  impl.face_patches.resize(impl.first_patch.back());
  std::vector<uint32_t> next(impl.first_patch.begin(), impl.first_patch.end() - 1);
  visit([&](size_t face, const auto& handle) { impl.face_patches[next[face]++] = handle; });
}

// OpenSubdiv's own StencilTableFactory casts its result to a type that it does not have, so its base class is
// used instead.
using Stencils = Far::StencilTableReal<float>;
using StencilsFactory = Far::StencilTableFactoryReal<float>;

/// Appends the stencils from `first`, whose sources count from point `origin`, after the existing terms.
void append_rules(const Stencils& stencils, size_t first, size_t count, uint32_t origin, size_t& term,
                  PointRules& rules) {
  for (size_t i = first; i < first + count; ++i) {
    for (int k = 0; k < stencils.GetSizes()[i]; ++k, ++term) {
      rules.source.push_back(origin + static_cast<uint32_t>(stencils.GetControlIndices()[term]));
      rules.weight.push_back(stencils.GetWeights()[term]);
    }
    rules.first_term.push_back(static_cast<uint32_t>(rules.source.size()));
  }
}

PointRules make_rules(const Far::TopologyRefiner& refiner, const Far::PatchTable& patches,
                      const std::function<void()>& check_stop) {
  PointRules rules;
  rules.control_count = static_cast<uint32_t>(refiner.GetLevel(0).GetNumVertices());
  // Not composed: the stencils of a level refer to points of the previous level, counted from its start.
  StencilsFactory::Options options;
  options.factorizeIntermediateLevels = false;
  const std::unique_ptr<const Stencils> refined(StencilsFactory::Create(refiner, options));
  check_stop();
  const Stencils* local = patches.GetLocalPointStencilTable<float>();
  rules.first_term.reserve(1 + refined->GetSizes().size() + (local ? local->GetSizes().size() : 0));
  rules.first_term.push_back(0);
  rules.source.reserve(refined->GetWeights().size());
  rules.weight.reserve(refined->GetWeights().size());
  size_t first = 0, term = 0;
  uint32_t origin = 0;
  for (int level = 1; level < refiner.GetNumLevels(); ++level) {
    const auto count = static_cast<size_t>(refiner.GetLevel(level).GetNumVertices());
    append_rules(*refined, first, count, origin, term, rules);
    first += count;
    origin += static_cast<uint32_t>(refiner.GetLevel(level - 1).GetNumVertices());
  }
  if (local) {
    // The patches store these terms anyway.
    rules.local_source = local->GetControlIndices().data();
    rules.local_weight = local->GetWeights().data();
    for (const int size : local->GetSizes())
      rules.first_term.push_back(rules.first_term.back() + static_cast<uint32_t>(size));
  }
  return rules;
}

}  // namespace

void SurfaceTopology::Impl::list_uses(uint32_t vertices) {
  first_use.assign(size_t(vertices) + 1, 0);
  for (const uint32_t v : cage.corner_vertex) ++first_use[v + 1];
  for (size_t v = 1; v < first_use.size(); ++v) first_use[v] += first_use[v - 1];
  uses.resize(cage.corner_vertex.size());
  std::vector<uint32_t> next(first_use.begin(), first_use.end() - 1);
  for (uint32_t face = 0; face < cage.face_count(); ++face) {
    for (uint32_t corner = cage.first_corner[face]; corner < cage.first_corner[face + 1]; ++corner)
      uses[next[cage.corner_vertex[corner]]++] = flat ? corner : face;
  }
}

size_t CageConnectivity::bytes() const {
  return topology_bytes(first_corner) + topology_bytes(corner_vertex) + topology_bytes(corner_edge) +
         topology_bytes(edge_vertices) + topology_bytes(edge_split) + topology_bytes(vertex_split) +
         topology_bytes(first_ptex);
}

SurfaceTopology::SurfaceTopology(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
SurfaceTopology::~SurfaceTopology() = default;

std::shared_ptr<const SurfaceTopology> SurfaceTopology::create(const ControlMesh& mesh,
                                                               SubdivisionScheme scheme,
                                                               BoundaryRule boundary,
                                                               const std::string& source) {
  return create(mesh, scheme, boundary, source, [] {});
}

std::shared_ptr<const SurfaceTopology> SurfaceTopology::create(const ControlMesh& mesh,
                                                               SubdivisionScheme scheme,
                                                               BoundaryRule boundary,
                                                               const std::string& source, const Job& job) {
  return create(mesh, scheme, boundary, source, [&job] { job.check_stop(); });
}

std::shared_ptr<const SurfaceTopology> SurfaceTopology::create(const ControlMesh& mesh,
                                                               SubdivisionScheme scheme,
                                                               BoundaryRule boundary,
                                                               const std::string& source,
                                                               const std::function<void()>& check_stop) {
  check_cage(mesh, scheme, source);
  auto impl = std::make_unique<Impl>();
  impl->control_count = static_cast<uint32_t>(mesh.positions.size());
  impl->hash = hash_cage(mesh, scheme, boundary);
  if (scheme == SubdivisionScheme::kNone) {
    fill_flat_topology(mesh, check_stop, *impl);
    return std::shared_ptr<const SurfaceTopology>(new SurfaceTopology(std::move(impl)));
  }
  const std::unique_ptr<Far::TopologyRefiner> refiner = make_refiner(mesh, scheme, boundary, source);
  impl->triangular = scheme == SubdivisionScheme::kLoop;
  impl->cage = connect_cage(*refiner, scheme);
  fill_ptex_faces(*impl, refiner->GetLevel(0), mesh);
  impl->list_uses(impl->control_count);
  check_stop();

  Far::PatchTableFactory::Options options(sharp_levels(mesh, tangled_face_count(mesh, vertex_fans(mesh))));
  options.SetEndCapType(Far::PatchTableFactory::Options::ENDCAP_GREGORY_BASIS);
  options.useInfSharpPatch = true;
  options.generateVaryingTables = false;
  options.generateLegacySharpCornerPatches = false;
  Far::TopologyRefiner::AdaptiveOptions levels = options.GetRefineAdaptiveOptions();
  levels.SetSecondaryLevel(smooth_levels(mesh));
  refiner->RefineAdaptive(levels);
  check_stop();
  impl->patches.reset(Far::PatchTableFactory::Create(*refiner, options));
  check_stop();
  impl->patch_map.emplace(*impl->patches);
  sort_patches(*impl);
  impl->rules = make_rules(*refiner, *impl->patches, check_stop);
  return std::shared_ptr<const SurfaceTopology>(new SurfaceTopology(std::move(impl)));
}

bool SurfaceTopology::is_triangular() const { return impl_->triangular; }
bool SurfaceTopology::is_flat() const { return impl_->flat; }
uint32_t SurfaceTopology::face_count() const { return static_cast<uint32_t>(impl_->cage_face.size()); }
uint32_t SurfaceTopology::control_count() const { return impl_->control_count; }
bool SurfaceTopology::is_hole(uint32_t face) const { return impl_->hole[face] != 0; }
uint32_t SurfaceTopology::cage_face(uint32_t face) const {
  return impl_->polygon.empty() ? impl_->cage_face[face] : impl_->polygon[face];
}
ContentHash SurfaceTopology::hash() const { return impl_->hash; }

int SurfaceTopology::neighbour(uint32_t face, int edge) const {
  return impl_->neighbours[face * impl_->corners_per_face() + static_cast<uint32_t>(edge)];
}

V2f SurfaceTopology::texture_coordinates(uint32_t face, float u, float v) const {
  if (impl_->uv.empty()) return {u, v};
  const V2f* c = &impl_->uv[size_t(face) * impl_->corners_per_face()];
  if (impl_->triangular) return c[0] * (1 - u - v) + c[1] * u + c[2] * v;
  return (c[0] * (1 - u) + c[1] * u) * (1 - v) + (c[3] * (1 - u) + c[2] * u) * v;
}

size_t SurfaceTopology::bytes() const {
  const Impl& i = *impl_;
  size_t bytes = sizeof(Impl) + i.cage.bytes() + topology_bytes(i.cage_face) + topology_bytes(i.hole) +
                 topology_bytes(i.part) + topology_bytes(i.neighbours) + topology_bytes(i.uv) +
                 topology_bytes(i.polygon) + topology_bytes(i.first_use) + topology_bytes(i.uses);
  if (i.flat) return bytes;
  const Far::PatchTable& patches = *i.patches;
  const size_t patch_count = patches.GetPatchParamTable().size();
  bytes +=
      patches.GetPatchControlVerticesTable().size() * sizeof(int) + patch_count * sizeof(Far::PatchParam);
  // The patch map: a handle per patch, one tree node per ptex face and one per three patches.
  bytes += patch_count * sizeof(Far::PatchTable::PatchHandle) + (patch_count / 3 + i.cage_face.size()) * 16;
  bytes += topology_bytes(i.first_patch) + topology_bytes(i.face_patches);
  if (const Stencils* local = patches.GetLocalPointStencilTable<float>()) {
    bytes += topology_bytes(local->GetSizes()) + topology_bytes(local->GetOffsets()) +
             topology_bytes(local->GetControlIndices()) + topology_bytes(local->GetWeights());
  }
  bytes += i.rules.bytes();
  return bytes;
}

}  // namespace pelage
