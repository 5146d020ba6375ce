// SPDX-License-Identifier: Apache-2.0
#include "why/why_json.h"

#include <nlohmann/json.hpp>

#include "why/why_text.h"

namespace pelage {
namespace {

using nlohmann::json;

json list(const V2f& v) { return {v.x, v.y}; }
json list(const V3f& v) { return {v.x, v.y, v.z}; }
json list(const Rgb& v) { return {v.x, v.y, v.z}; }

json places_json(const StrandPlaces& places) {
  json result{{"length", places.length}};
  for (size_t i = 0; i < StrandPlaces::kNames.size(); ++i) {
    json& place = result[StrandPlaces::kNames[i]];
    place = {{"position", list(places.position[i])}, {"width", places.width[i]}};
    if (places.color) place["color"] = list((*places.color)[i]);
  }
  return result;
}

/// What a step moved the strand by.
json moves_json(const StrandPlaces& before, const StrandPlaces& after) {
  json result;
  for (size_t i = 0; i < StrandPlaces::kNames.size(); ++i)
    result[StrandPlaces::kNames[i]] = list(after.position[i] - before.position[i]);
  return result;
}

json lod_json(const LodWhy& lod) {
  const LodMeasures& m = lod.measures;
  return {{"width_pixels", m.width},
          {"length_pixels", m.length},
          {"motion_pixels", m.motion},
          {"motion_across_pixels", m.across},
          {"confusion_pixels", m.confusion},
          {"facing", m.facing},
          {"size_share", m.size_share},
          {"blur_share", m.blur_share},
          {"facing_share", m.facing_share},
          {"budget", m.budget},
          {"share", m.share},
          {"priority", lod.priority},
          {"fade", lod.fade},
          {"width_factor", lod.width},
          {"contrast", lod.contrast},
          {"tolerance", lod.tolerance}};
}

json strand_json(const StrandWhy& strand) {
  json result{{"coat", strand.coat},
              {"id", strand.id},
              {"segment", strand.segment},
              {"along", strand.along},
              {"across", strand.across},
              {"root_uv", list(strand.root_uv)},
              {"root", json()},
              {"lod", json()},
              {"steps", json::array()},
              {"outline", json::array()},
              {"rest", list(strand.rest)}};
  if (strand.root)
    result["root"] = {{"face", strand.root->face}, {"u", strand.root->u}, {"v", strand.root->v}};
  if (strand.lod) result["lod"] = lod_json(*strand.lod);
  for (size_t i = 0; i < strand.steps.size(); ++i) {
    json step{{"name", strand.steps[i].name}, {"after", places_json(strand.steps[i].after)}};
    if (i > 0) step["moved"] = moves_json(strand.steps[i - 1].after, strand.steps[i].after);
    result["steps"].push_back(std::move(step));
  }
  for (const V2f& point : strand.outline) result["outline"].push_back(list(point));
  return result;
}

json chunk_json(const ChunkWhy& chunk) {
  return {{"index", chunk.index},
          {"strands", chunk.strands},
          {"bytes", chunk.bytes},
          {"box", {list(chunk.box.min), list(chunk.box.max)}},
          {"segment_cell_bounds", chunk.segment_cell_bounds},
          {"growths", chunk.growths}};
}

json material_json(const MaterialWhy& material) {
  json parameters = json::object();
  for (const ParameterText& parameter : material.parameters) parameters[parameter.key] = parameter.text;
  return {{"name", material.name},
          {"model", material.model},
          {"parameters", std::move(parameters)},
          {"color", list(material.color)},
          {"opacity", material.opacity}};
}

}  // namespace

std::string why_json(const PixelWhy& why) {
  json result{{"pixel", {why.x, why.y}},
              {"samples", why.samples},
              {"radiance", list(why.radiance)},
              {"alpha", why.alpha},
              {"noise", json()},
              {"depth", json()},
              {"adaptive", why.is_adaptive},
              {"strand", json()},
              {"chunk", json()},
              {"skin", json()},
              {"material", json()},
              {"lights", json::array()},
              {"seen", json::array()}};
  if (why.noise) result["noise"] = *why.noise;
  if (why.strand || why.skin) result["depth"] = why.depth;
  for (const LightTerm& term : why.lights) {
    result["lights"].push_back({{"light", term.light},
                                {"lobe", term.lobe},
                                {"event", term.event.empty() ? json() : json(term.event)},
                                {"radiance", list(term.radiance)}});
  }
  for (const SeenCount& seen : why.seen) {
    result["seen"].push_back({{"name", seen.name.empty() ? json() : json(seen.name)},
                              {"strand", seen.strand ? json(*seen.strand) : json()},
                              {"samples", seen.samples}});
  }
  if (why.strand) result["strand"] = strand_json(*why.strand);
  if (why.chunk) result["chunk"] = chunk_json(*why.chunk);
  if (why.skin) {
    result["skin"] = {{"name", why.skin->name},
                      {"face", why.skin->face},
                      {"place", list(why.skin->place)},
                      {"uv", list(why.skin->uv)},
                      {"rest", list(why.skin->rest)}};
  }
  if (why.material) result["material"] = material_json(*why.material);
  const CostWhy& cost = why.cost;
  result["cost"] = {{"camera_rays", cost.rays.camera},     {"shadow_rays", cost.rays.shadow},
                    {"indirect_rays", cost.rays.indirect}, {"trace_s", cost.trace_s},
                    {"growth_s", cost.growth_s},           {"strands_grown", cost.strands_grown}};
  result["text"] = why_text(why);
  // Names may contain bytes that are not UTF-8.
  return result.dump(-1, ' ', false, json::error_handler_t::replace);
}

}  // namespace pelage
