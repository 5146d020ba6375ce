// SPDX-License-Identifier: Apache-2.0
#include "exchange/mitsuba/mitsuba_scene.h"

#include <cmath>
#include <numbers>

#include "exchange/still_scene.h"

namespace pelage {
namespace {

using Kind = ExportedLight::Kind;
constexpr float kMitsubaPi = std::numbers::pi_v<float>;

/// Mitsuba reads matrices row by row for column vectors; ours are for row vectors.
std::string mitsuba_matrix(const M44f& m) {
  std::string text;
  for (int i = 0; i < 16; ++i) text += fmt::format("{}{}", i > 0 ? " " : "", m[i % 4][i / 4]);
  return text;
}

std::string xml_text(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == '&') {
      out += "&amp;";
    } else if (c == '<') {
      out += "&lt;";
    } else if (c == '"') {
      out += "&quot;";
    } else {
      out += c;
    }
  }
  return out;
}

/// One line per point, and an empty line between strands.
void write_mitsuba_leaf(const std::filesystem::path& file, const Strands& strands) {
  ExportedText text(file);
  for (size_t s = 0; s < strands.strand_count(); ++s) {
    if (segment_count(strands.basis(), strands.strand_points(s)) == 0) continue;
    const std::vector<float> points = bspline_points(strands, s);
    for (size_t i = 0; i < points.size(); i += 4)
      text.add("{} {} {} {}\n", points[i], points[i + 1], points[i + 2], points[i + 3]);
    text.add("\n");
  }
  text.commit();
}

class MitsubaFrame {
 public:
  MitsubaFrame(const std::filesystem::path& path, const StillScene& scene,
               const SceneDescription& description, ExportNotes& notes)
      : text_(path), scene_(scene), description_(description), notes_(notes) {}

  void write(int frame) {
    text_.add("<scene version=\"3.0.0\">\n");
    // Mitsuba counts the ray of the camera and the ray to the light.
    text_.add("  <integrator type=\"path\"><integer name=\"max_depth\" value=\"{}\"/></integrator>\n",
              description_.render.bounces + 2);
    write_camera(frame);
    for (const ExportedMaterial& material : scene_.materials) write_material(material);
    for (const ExportedLight& light : scene_.lights) write_light(light);
    for (const StillScene::Part& skin : scene_.skins) write_shape("ply", skin, skin.files[0]);
    for (const StillScene::Part& coat : scene_.coats) {
      for (const std::string& file : coat.files) write_shape("bsplinecurve", coat, file);
    }
    text_.add("</scene>\n");
    text_.commit();
  }

 private:
  void number(const char* name, float value) {
    text_.add("    <float name=\"{}\" value=\"{}\"/>\n", name, value);
  }
  void rgb(const char* name, const Rgb& c) {
    text_.add("    <rgb name=\"{}\" value=\"{} {} {}\"/>\n", name, c.x, c.y, c.z);
  }
  void transform(const M44f& m) {
    text_.add("    <transform name=\"to_world\"><matrix value=\"{}\"/></transform>\n", mitsuba_matrix(m));
  }

  void write_shape(const char* type, const StillScene::Part& part, const std::string& file) {
    text_.add("  <shape type=\"{}\"><string name=\"filename\" value=\"{}\"/><ref id=\"{}\"/></shape>\n", type,
              xml_text(file), xml_text(scene_.materials[part.material].name));
  }

  void write_camera(int frame) {
    const CameraParams& camera = scene_.camera;
    const ImageParams& image = description_.image;
    const float aspect = static_cast<float>(image.width) / static_cast<float>(image.height);
    const std::optional<LensParams> lens = camera.lens_at(frame, aspect);
    const char* type = camera.is_orthographic() ? "orthographic" : lens ? "thinlens" : "perspective";
    text_.add("  <sensor type=\"{}\">\n", type);
    // Mitsuba's camera looks along +z and has x to the left; ours of this matrix has x to the right.
    M44f to_world =
        M44f(-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1) * scene_.view.world_to_camera().inverse();
    if (camera.is_orthographic()) {
      const float half = 0.5f * aspect * camera.height_at(frame, aspect);
      M44f scale;
      scale.setScale(V3f(half, half, 1));
      to_world = scale * to_world;
    } else {
      text_.add("    <string name=\"fov_axis\" value=\"y\"/>\n");
      number("fov", camera.fov_at(frame, aspect));
    }
    if (camera.shift != V2f(0)) {
      number("principal_point_offset_x", camera.shift.x);
      number("principal_point_offset_y", -camera.shift.y);
    }
    if (lens && !camera.is_orthographic()) {
      number("aperture_radius", 0.5f * lens->focal_length / lens->f_stop);
      number("focus_distance", lens->focus_distance);
    }
    transform(to_world);
    text_.add(
        "    <film type=\"hdrfilm\">\n      <integer name=\"width\" value=\"{}\"/>\n      <integer "
        "name=\"height\" "
        "value=\"{}\"/>\n    </film>\n",
        image.width, image.height);
    text_.add(
        "    <sampler type=\"independent\"><integer name=\"sample_count\" value=\"{}\"/></sampler>\n  "
        "</sensor>\n",
        description_.render.samples);
  }

  void write_material(const ExportedMaterial& material) {
    const char* type = material.hair                                            ? "hair"
                       : std::holds_alternative<GlossyParams>(*material.params) ? "roughplastic"
                                                                                : "twosided";
    text_.add("  <bsdf type=\"{}\" id=\"{}\">\n", type, xml_text(material.name));
    if (material.hair) {
      const HairModel& hair = *material.hair;
      rgb("sigma_a", hair.absorption);
      number("int_ior", hair.eta);
      number("ext_ior", 1);
      number("longitudinal_roughness", hair.beta_m);
      number("azimuthal_roughness", hair.beta_n);
      number("scale_tilt", -hair.alpha);  // tilted the other way, as in pbrt
    } else if (const auto* glossy = std::get_if<GlossyParams>(material.params)) {
      rgb("diffuse_reflectance", material.color);
      number("alpha", glossy->roughness * glossy->roughness);
      number("int_ior", glossy->ior);
      number("ext_ior", 1);
    } else {
      text_.add("    <bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"{} {} {}\"/></bsdf>\n",
                material.color.x, material.color.y, material.color.z);
    }
    text_.add("  </bsdf>\n");
  }

  void write_light(const ExportedLight& light) {
    const std::string subject = "light '" + light.name + "'";
    if (!light.shadows) notes_.add(subject, "it casts shadows");
    switch (light.kind) {
      case Kind::kSun:
        return write_sun(light);
      case Kind::kSpot:
        return write_spot(light);
      case Kind::kEnvironment:
        return write_environment(light);
      default:
        break;
    }
    if (!light.visible) notes_.add(subject, "the camera sees it");
    write_area_light(light);
  }

  void write_sun(const ExportedLight& light) {
    const float sine = std::sin(light.angle * kMitsubaPi / 360);
    text_.add("  <emitter type=\"directional\">\n");
    rgb("irradiance", light.radiance * (kMitsubaPi * sine * sine));
    text_.add("    <vector name=\"direction\" x=\"{}\" y=\"{}\" z=\"{}\"/>\n  </emitter>\n", light.z.x,
              light.z.y, light.z.z);
    notes_.add("light '" + light.name + "'", "it has no size: its shadows are sharp");
  }

  void write_spot(const ExportedLight& light) {
    const std::string subject = "light '" + light.name + "'";
    text_.add("  <emitter type=\"spot\">\n");
    rgb("intensity", light.radiance * (kMitsubaPi * light.radius * light.radius));
    number("cutoff_angle", light.angle);
    number("beam_width", light.angle * (1 - light.softness));
    transform(M44f(light.x.x, light.x.y, light.x.z, 0, light.y.x, light.y.y, light.y.z, 0, light.z.x,
                   light.z.y, light.z.z, 0, light.position.x, light.position.y, light.position.z, 1));
    text_.add("  </emitter>\n");
    notes_.add(subject, "it has no size: its shadows are sharp");
    notes_.add(subject, "its cone fades linearly with the angle");
    if (!light.image.empty()) notes_.add(subject, "its gobo is lost");
  }

  /// Column 0 of Mitsuba's images is along -z, that of ours along +z.
  void write_environment(const ExportedLight& light) {
    if (light.image.empty()) {
      text_.add("  <emitter type=\"constant\">\n");
      rgb("radiance", light.radiance);
      text_.add("  </emitter>\n");
      return;
    }
    text_.add("  <emitter type=\"envmap\">\n    <string name=\"filename\" value=\"{}\"/>\n",
              xml_text(std::filesystem::absolute(light.image).string()));
    number("scale", luminance(light.radiance));
    transform(M44f(-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1) * light.rotation);
    text_.add("  </emitter>\n");
    if (light.radiance.x != light.radiance.y || light.radiance.y != light.radiance.z)
      notes_.add("light '" + light.name + "'", "the colour that multiplies its image became grey");
  }

  void write_area_light(const ExportedLight& light) {
    const std::string subject = "light '" + light.name + "'";
    const V3f &p = light.position, &x = light.x, &y = light.y, &z = light.z;
    const bool rectangle = light.kind == Kind::kRectangle, disk = light.kind == Kind::kDisk;
    const char* type = rectangle ? "rectangle" : disk ? "disk" : light.kind == Kind::kMesh ? "ply" : "sphere";
    text_.add("  <shape type=\"{}\">\n", type);
    if (rectangle || disk) {
      const float u = rectangle ? 0.5f * light.size.x : light.radius,
                  v = rectangle ? 0.5f * light.size.y : light.radius;
      transform(M44f(u * x.x, u * x.y, u * x.z, 0, v * y.x, v * y.y, v * y.z, 0, z.x, z.y, z.z, 0, p.x, p.y,
                     p.z, 1));
    } else if (light.kind == Kind::kMesh) {
      text_.add("    <string name=\"filename\" value=\"{}\"/>\n", light.image);
    } else {
      number("radius", light.radius);
      text_.add("    <point name=\"center\" x=\"{}\" y=\"{}\" z=\"{}\"/>\n", p.x, p.y, p.z);
    }
    if (light.two_sided) notes_.add(subject, "it shines to one side only");
    if (rectangle && !light.image.empty()) notes_.add(subject, "its image is lost");
    // The surface of a light reflects nothing.
    text_.add(
        "    <bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"0 0 0\"/></bsdf>\n    <emitter "
        "type=\"area\">"
        "<rgb name=\"radiance\" value=\"{} {} {}\"/></emitter>\n  </shape>\n",
        light.radiance.x, light.radiance.y, light.radiance.z);
  }

  ExportedText text_;
  const StillScene& scene_;
  const SceneDescription& description_;
  ExportNotes& notes_;
};

}  // namespace

std::vector<std::filesystem::path> write_mitsuba_scene(const std::filesystem::path& folder,
                                                       const ExportSource& source, ExportNotes& notes,
                                                       const Job& job) {
  std::vector<std::filesystem::path> paths;
  size_t frame = 0;
  for_each_still(
      folder, source, ".txt", write_mitsuba_leaf, notes, job,
      [&](const StillScene& scene, const std::string& stem) {
        paths.push_back(folder / (stem + ".xml"));
        MitsubaFrame(paths.back(), scene, source.scene, notes).write(source.scene.frames.frames[frame++]);
      });
  return paths;
}

}  // namespace pelage
