// SPDX-License-Identifier: Apache-2.0
#include "exchange/pbrt/pbrt_scene.h"

#include <cmath>
#include <numbers>

#include "exchange/still_scene.h"
#include "geom/interchange/unique_names.h"

namespace pelage {
namespace {

using Kind = ExportedLight::Kind;
constexpr float kPbrtPi = std::numbers::pi_v<float>;

/// pbrt reads matrices column by column for column vectors, which is row by row for our row vectors.
std::string pbrt_matrix(const M44f& m) {
  std::string text = "[";
  for (int i = 0; i < 16; ++i) text += fmt::format(" {}", m[i / 4][i % 4]);
  return text + " ]";
}

/// A text in quotes, or behind `#`: with the escapes of pbrt, and _ for other control characters.
std::string pbrt_text(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      out += '\\';
      out += c;
    } else {
      out += static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? '_' : c;
    }
  }
  return out;
}

/// Whether the radii at the ends of all segments are linear along the strand, within a hundredth of the
/// largest: pbrt has only a width at either end of a curve.
bool has_linear_widths(const std::vector<CubicSegment>& segments) {
  const float first = segments.front().r[0], last = segments.back().r[3];
  float largest = 0;
  for (const CubicSegment& s : segments) largest = std::max({largest, s.r[0], s.r[3]});
  for (size_t i = 0; i < segments.size(); ++i) {
    const float u = static_cast<float>(i) / static_cast<float>(segments.size());
    if (std::abs(segments[i].r[0] - (first + u * (last - first))) > 0.01f * largest) return false;
  }
  return true;
}

void add_points(ExportedText& text, const std::vector<CubicSegment>& segments, size_t begin, size_t end) {
  text.add("Shape \"curve\" \"float width0\" [ {} ] \"float width1\" [ {} ] \"point3 P\" [",
           2 * segments[begin].r[0], 2 * segments[end - 1].r[3]);
  const V3f& first = segments[begin].p[0];
  text.add(" {} {} {}", first.x, first.y, first.z);
  for (size_t i = begin; i < end; ++i) {
    for (size_t k = 1; k < 4; ++k) {
      const V3f& p = segments[i].p[k];
      text.add(" {} {} {}", p.x, p.y, p.z);
    }
  }
  text.add(" ]\n");
}

/// B-splines of linear width keep their points. All others are Bezier segments.
void write_pbrt_leaf(const std::filesystem::path& file, const Strands& strands) {
  ExportedText text(file);
  std::vector<CubicSegment> segments;
  const bool spline =
      strands.basis() == CurveBasis::kPinnedBSpline || strands.basis() == CurveBasis::kBSpline;
  for (size_t s = 0; s < strands.strand_count(); ++s) {
    segments.clear();
    const uint32_t count = segment_count(strands.basis(), strands.strand_points(s));
    for (uint32_t i = 0; i < count; ++i) segments.push_back(bezier_segment(strands, s, i));
    if (segments.empty()) continue;
    const bool linear = has_linear_widths(segments);
    if (!linear) {
      for (size_t i = 0; i < segments.size(); ++i) add_points(text, segments, i, i + 1);
    } else if (spline) {
      text.add(
          "Shape \"curve\" \"string basis\" \"bspline\" \"float width0\" [ {} ] \"float width1\" [ {} ] "
          "\"point3 P\" [",
          2 * segments.front().r[0], 2 * segments.back().r[3]);
      const std::vector<float> points = bspline_points(strands, s);
      for (size_t i = 0; i < points.size(); i += 4)
        text.add(" {} {} {}", points[i], points[i + 1], points[i + 2]);
      text.add(" ]\n");
    } else {
      add_points(text, segments, 0, segments.size());
    }
  }
  text.commit();
}

class PbrtFrame {
 public:
  PbrtFrame(const std::filesystem::path& path, const StillScene& scene, const SceneDescription& description,
            ExportNotes& notes)
      : text_(path), scene_(scene), description_(description), notes_(notes) {}

  void write(const std::string& stem, int frame) {
    write_options(stem);
    write_camera(frame);
    text_.add("WorldBegin\n\n");
    for (const ExportedLight& light : scene_.lights) write_light(light);
    UniqueNames names;
    for (const ExportedMaterial& material : scene_.materials) {
      material_names_.push_back(names.unique(material.name));
      write_material(material);
    }
    for (const StillScene::Part& skin : scene_.skins) {
      text_.add("\n# skin {}\nNamedMaterial \"{}\"\n", pbrt_text(skin.name), material_name(skin));
      text_.add("Shape \"plymesh\" \"string filename\" \"{}\"\n", skin.files[0]);
    }
    for (const StillScene::Part& coat : scene_.coats) {
      text_.add("\n# coat {}\nNamedMaterial \"{}\"\n", pbrt_text(coat.name), material_name(coat));
      for (const std::string& file : coat.files) text_.add("Include \"{}\"\n", file);
    }
    text_.commit();
  }

 private:
  std::string material_name(const StillScene::Part& part) const { return material_names_[part.material]; }
  static std::string rgb(const Rgb& c) { return fmt::format("[ {} {} {} ]", c.x, c.y, c.z); }

  void write_options(const std::string& stem) {
    const ImageParams& image = description_.image;
    text_.add(
        "Film \"rgb\" \"integer xresolution\" [ {} ] \"integer yresolution\" [ {} ] \"string filename\" "
        "\"{}.exr\"\n",
        image.width, image.height, pbrt_text(stem));
    text_.add("Sampler \"zsobol\" \"integer pixelsamples\" [ {} ]\n", description_.render.samples);
    text_.add("Integrator \"path\" \"integer maxdepth\" [ {} ]\n\n", description_.render.bounces + 1);
  }

  void write_camera(int frame) {
    const CameraParams& camera = scene_.camera;
    const float aspect =
        static_cast<float>(description_.image.width) / static_cast<float>(description_.image.height);
    const float half = camera.is_orthographic() ? 0.5f * camera.height_at(frame, aspect)
                                                : std::tan(camera.fov_at(frame, aspect) * kPbrtPi / 360);
    const float right = 2 * half * aspect * camera.shift.x, up = 2 * half * camera.shift.y;
    text_.add("Transform {}\n", pbrt_matrix(scene_.view.world_to_camera()));
    // At 90 degrees, the window is in units of the distance.
    text_.add("Camera \"{}\"{} \"float screenwindow\" [ {} {} {} {} ]",
              camera.is_orthographic() ? "orthographic" : "perspective",
              camera.is_orthographic() ? "" : " \"float fov\" [ 90 ]", right - half * aspect,
              right + half * aspect, up - half, up + half);
    if (const std::optional<LensParams> lens = camera.lens_at(frame, aspect)) {
      text_.add(" \"float lensradius\" [ {} ] \"float focaldistance\" [ {} ]",
                0.5f * lens->focal_length / lens->f_stop, lens->focus_distance);
    }
    text_.add("\n\n");
  }

  void write_light(const ExportedLight& light) {
    const std::string subject = "light '" + light.name + "'";
    const V3f &p = light.position, to = p + light.z;
    text_.add("# light {}\n", pbrt_text(light.name));
    if (!light.shadows) notes_.add(subject, "it casts shadows");
    if (light.kind == Kind::kSun) {
      const float sine = std::sin(light.angle * kPbrtPi / 360);
      text_.add("LightSource \"distant\" \"rgb L\" {} \"point3 from\" [ 0 0 0 ] \"point3 to\" [ {} {} {} ]\n",
                rgb(light.radiance * (kPbrtPi * sine * sine)), light.z.x, light.z.y, light.z.z);
      notes_.add(subject, "it has no size: its shadows are sharp");
      return;
    }
    if (light.kind == Kind::kSpot) {
      const float area = kPbrtPi * light.radius * light.radius;
      text_.add("LightSource \"spot\" \"rgb I\" {} \"point3 from\" [ {} {} {} ] \"point3 to\" [ {} {} {} ]",
                rgb(light.radiance * area), p.x, p.y, p.z, to.x, to.y, to.z);
      text_.add(" \"float coneangle\" [ {} ] \"float conedeltaangle\" [ {} ]\n", light.angle,
                light.angle * light.softness);
      notes_.add(subject, "it has no size: its shadows are sharp");
      if (!light.image.empty()) notes_.add(subject, "its gobo is lost");
      return;
    }
    if (light.kind == Kind::kEnvironment) return write_environment(light);
    write_area_light(light);
    if (!light.visible) notes_.add(subject, "the camera sees it");
  }

  /// pbrt has images of the whole sphere in its own mapping, which its program imgtool makes. Their axis is
  /// z.
  void write_environment(const ExportedLight& light) {
    if (light.image.empty()) {
      text_.add("LightSource \"infinite\" \"rgb L\" {}\n", rgb(light.radiance));
      return;
    }
    const std::filesystem::path image = light.image;
    const std::string made = image.stem().string() + "_equal_area.exr";
    const M44f turn(0, 0, 1, 0, -1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 1);
    text_.add("AttributeBegin\nTransform {}\n", pbrt_matrix(turn * light.rotation));
    text_.add("LightSource \"infinite\" \"string filename\" \"{}\" \"float scale\" [ {} ]\nAttributeEnd\n",
              pbrt_text(made), luminance(light.radiance));
    notes_.add("light '" + light.name + "'",
               fmt::format("make its image first: `imgtool makeequiarea --outfile {} {}`", made,
                           std::filesystem::absolute(image).string()));
    if (light.radiance.x != light.radiance.y || light.radiance.y != light.radiance.z)
      notes_.add("light '" + light.name + "'", "the colour that multiplies its image became grey");
  }

  void write_area_light(const ExportedLight& light) {
    text_.add("AttributeBegin\nAreaLightSource \"diffuse\" \"rgb L\" {}{}\n", rgb(light.radiance),
              light.two_sided ? " \"bool twosided\" true" : "");
    // The surface of a light reflects nothing.
    text_.add("Material \"diffuse\" \"rgb reflectance\" [ 0 0 0 ]\n");
    const V3f &p = light.position, &x = light.x, &y = light.y, &z = light.z;
    if (light.kind == Kind::kRectangle) {
      if (!light.image.empty()) notes_.add("light '" + light.name + "'", "its image is lost");
      const V3f u = 0.5f * light.size.x * x, v = 0.5f * light.size.y * y;
      text_.add("Shape \"bilinearmesh\" \"point3 P\" [");
      for (const V3f& corner : {p - u - v, p + u - v, p - u + v, p + u + v})
        text_.add(" {} {} {}", corner.x, corner.y, corner.z);
      text_.add(" ]\n");
    } else if (light.kind == Kind::kDisk) {
      text_.add("Transform {}\n",
                pbrt_matrix(M44f(x.x, x.y, x.z, 0, y.x, y.y, y.z, 0, z.x, z.y, z.z, 0, p.x, p.y, p.z, 1)));
      text_.add("Shape \"disk\" \"float radius\" [ {} ]\n", light.radius);
    } else if (light.kind == Kind::kMesh) {
      text_.add("Shape \"plymesh\" \"string filename\" \"{}\"\n", light.image);
    } else {
      text_.add("Translate {} {} {}\nShape \"sphere\" \"float radius\" [ {} ]\n", p.x, p.y, p.z,
                light.radius);
    }
    text_.add("AttributeEnd\n");
  }

  void write_material(const ExportedMaterial& material) {
    text_.add("MakeNamedMaterial \"{}\" ", material_names_.back());
    if (material.hair) {
      const HairModel& hair = *material.hair;
      text_.add("\"string type\" \"hair\" \"rgb sigma_a\" {} \"float eta\" [ {} ] \"float beta_m\" [ {} ]",
                rgb(hair.absorption), hair.eta, hair.beta_m);
      // pbrt tilts the scales the other way.
      text_.add(" \"float beta_n\" [ {} ] \"float alpha\" [ {} ]\n", hair.beta_n, -hair.alpha);
    } else if (const auto* glossy = std::get_if<GlossyParams>(material.params)) {
      text_.add(
          "\"string type\" \"coateddiffuse\" \"rgb reflectance\" {} \"float roughness\" [ {} ] \"float eta\" "
          "[ {} ] "
          "\"bool remaproughness\" false\n",
          rgb(material.color), glossy->roughness * glossy->roughness, glossy->ior);
    } else {
      text_.add("\"string type\" \"diffuse\" \"rgb reflectance\" {}\n", rgb(material.color));
    }
  }

  ExportedText text_;
  const StillScene& scene_;
  const SceneDescription& description_;
  ExportNotes& notes_;
  std::vector<std::string> material_names_;  // of scene_.materials, without characters that need quotes
};

}  // namespace

std::vector<std::filesystem::path> write_pbrt_scene(const std::filesystem::path& folder,
                                                    const ExportSource& source, ExportNotes& notes,
                                                    const Job& job) {
  notes.add("picture",
            "pbrt renders spectra: colours of dense fur differ slightly from those of a renderer in RGB");
  std::vector<std::filesystem::path> paths;
  size_t frame = 0;
  for_each_still(
      folder, source, ".pbrt", write_pbrt_leaf, notes, job,
      [&](const StillScene& scene, const std::string& stem) {
        paths.push_back(folder / (stem + ".pbrt"));
        PbrtFrame(paths.back(), scene, source.scene, notes).write(stem, source.scene.frames.frames[frame++]);
      });
  return paths;
}

}  // namespace pelage
