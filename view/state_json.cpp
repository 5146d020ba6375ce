// SPDX-License-Identifier: Apache-2.0
#include "view/state_json.h"

#include <nlohmann/json.hpp>

namespace pelage {

std::string state_json(const ViewStatus& status, const Picture* picture,
                       const std::optional<PixelBox>& region) {
  nlohmann::json state;
  state["done"] = status.done();
  state["error"] = status.error();
  state["stage"] = status.stage;
  state["progress"] = status.progress;
  state["samples"] = status.mean_samples;
  state["wanted_samples"] = status.wanted_samples;
  state["strands_regrown"] = status.strands_regrown;
  state["first_pixels_s"] = status.first_pixels_s;
  state["render_s"] = status.render_s;
  state["memory_bytes"] = status.memory_bytes;
  state["edits"] = status.edits;
  const auto list = [](const V3f& v) { return nlohmann::json{v.x, v.y, v.z}; };
  const ViewCamera& camera = status.camera;
  state["camera"] = {{"position", list(camera.position)},
                     {"look_at", list(camera.look_at)},
                     {"up", list(camera.up)},
                     {"fov", camera.fov},
                     {"moved", camera.moved},
                     {"note", status.camera_note}};
  state["region"] =
      region ? nlohmann::json{region->x0, region->y0, region->x1, region->y1} : nlohmann::json();
  state["layers"] = status.layers;
  state["warnings"] = status.warnings;
  state["version"] = picture ? picture->version : 0;
  state["width"] = picture ? picture->width : 0;
  state["height"] = picture ? picture->height : 0;
  // File names may contain bytes that are not UTF-8.
  return state.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace pelage
