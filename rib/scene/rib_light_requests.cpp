// SPDX-License-Identifier: Apache-2.0
// Lights.
#include "base/nearest_name.h"
#include "rib/scene/rib_interpreter.h"

namespace pelage {
namespace {

/// Whether the second argument is a handle rather than the name of a parameter, which has a value.
bool has_handle(const RibStatement& request) {
  return request.arguments.size() > 1 && request.arguments.size() % 2 == 0;
}

}  // namespace

std::string RibInterpreter::light_name(const RibShader& shader) {
  const RibSetting* name = shader.find("name");
  if (name && name->strings.size() == 1 && !name->strings[0].empty())
    return unique_name("light", name->strings[0]);
  return unique_name("light", now_.name.empty() ? shader.name : now_.name);
}

void RibInterpreter::add_light(RibLight light) {
  if (is_flattened(light.shader->position, light.to_world)) return;
  if (light.name.empty()) light.name = light_name(*light.shader);
  scene_.lights.push_back(std::move(light));
}

void RibInterpreter::light_source(const Call& call) {
  RibStatement& request = call.request();
  RibLight light;
  light.shader = shader_of(request, has_handle(request) ? 2 : 1);
  light.to_world = now_.to_world;
  find_map(light, request);
  add_light(std::move(light));
}

// Light "PxrRectLight" "handle" ...
void RibInterpreter::ris_light(const Call& call) {
  RibStatement& request = call.request();
  RibLight light;
  light.shader = shader_of(request, has_handle(request) ? 2 : 1);
  light.to_world = now_.to_world;
  light.is_ris = true;
  light.visible = now_.seen_by_camera;
  if (const RibSetting* name = light.shader->find("name"); !name && has_handle(request)) {
    const RibOperand& handle = request.arguments[1];
    if (handle.strings.size() == 1 && !handle.strings[0].empty())
      light.name = unique_name("light", handle.strings[0]);
  }
  find_map(light, request);
  add_light(std::move(light));
}

// A map that is missing does not stop other renderers either.
void RibInterpreter::find_map(RibLight& light, const RibStatement& request) {
  for (const char* key : {"filename", "texname", "map", "lightColorMap"}) {
    const RibSetting* file = light.shader->find(key);
    if (!file || file->strings.size() != 1 || file->strings[0].empty()) continue;
    if (light.shader->find("pelage")) return;
    const auto found = find_file(file->strings[0], context_.texture_path, request);
    if (found) light.map = std::filesystem::absolute(*found).lexically_normal();
    return;
  }
}

// Lights that are stated before the world are in the space of the camera.
void RibInterpreter::move_lights_to_world() {
  const M44f to_world = now_.to_world.at(0).inverse() * context_.world.at(0);
  for (RibLight& light : scene_.lights) light.to_world = RibTransform(light.to_world.at(0) * to_world);
}

void RibInterpreter::area_light_source(const Call& call) {
  RibStatement& request = call.request();
  now_.area = shader_of(request, has_handle(request) ? 2 : 1);
  if (now_.area->name.empty() || now_.area->name == "null") now_.area.reset();
}

void RibInterpreter::area_light(RibLight::Shape shape, float radius, std::vector<V3f> corners) {
  RibLight light;
  light.shader = now_.area;
  light.to_world = now_.to_world;
  light.shape = shape;
  light.radius = radius;
  light.corners = std::move(corners);
  add_light(std::move(light));
}

}  // namespace pelage
