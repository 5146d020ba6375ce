// SPDX-License-Identifier: Apache-2.0
#include "world/scene_schema.h"

namespace pelage {

bool ValueReader<FormatVersion>::read(const Value& value, const KeyOptions&, FormatVersion& out,
                                      Problems& problems) {
  if (value.is_scalar() && value.text() == "1") {
    out.number = 1;
    return true;
  }
  problems.add(value.position(), "this program reads scenes of format 1, got " + value.describe());
  return false;
}

const Schema<UnitsParams>& UnitsParams::schema() {
  static const Schema<UnitsParams> table = [] {
    Schema<UnitsParams> s("units", "What a scene unit and a frame are.");
    s.key("meters_per_unit", &UnitsParams::meters_per_unit,
          {.unit = "m", .help = "Length of one scene unit", .min = 0, .above_min = true});
    s.key("fps", &UnitsParams::fps,
          {.unit = "1/s", .help = "Frames per second", .min = 0, .above_min = true});
    return s;
  }();
  return table;
}

const Schema<PosesParams>& PosesParams::schema() {
  static const Schema<PosesParams> table = [] {
    Schema<PosesParams> s("poses",
                          "Posed copies of a cage, one file per frame, blended linearly between frames.");
    s.key("files", &PosesParams::files,
          {.help = "OBJ files with the vertices of the mesh; %04d, ####, $F4 or <F4> is the number",
           .required = true});
    s.key("first", &PosesParams::first, {.help = "Number of the first file, and the frame that shows it"});
    s.key("count", &PosesParams::count,
          {.help = "How many files there are", .required = true, .min = 1, .max = 1e6});
    s.key("frames_per_pose", &PosesParams::frames_per_pose,
          {.unit = "frames", .help = "From one pose to the next", .min = 0, .above_min = true});
    s.key("cycle", &PosesParams::cycle, {.help = "Begin again after the last pose, instead of holding it"});
    return s;
  }();
  return table;
}

const Schema<SkinParams>& SkinParams::schema() {
  static const Schema<SkinParams> table = [] {
    Schema<SkinParams> s("skin", "A subdivision surface, or a mesh as it is, that fur grows on.");
    s.key("mesh", &SkinParams::mesh, {.help = "OBJ file of the control cage at rest", .required = true});
    s.key("scheme", &SkinParams::scheme,
          {.help = "Subdivision scheme. `none` uses the polygons as they are, for dense meshes such as "
                   "scans: it cuts "
                   "them into triangles and interpolates normals between the vertices, for hair and for "
                   "shading. It "
                   "takes about 250 bytes a triangle; `catmull-clark` takes 4,500 to 14,000"});
    s.key("boundary", &SkinParams::boundary,
          {.help = "Whether corners of the boundary stay sharp, or are rounded like its edges"});
    s.key("poses", &SkinParams::poses,
          {.help = "Posed cages; without them the skin rests", .default_text = "at rest"});
    return s;
  }();
  return table;
}

const Schema<PartParams>& PartParams::schema() {
  static const Schema<PartParams> table = [] {
    Schema<PartParams> s("part", "One skin of a character and what grows on it.");
    s.key("skin", &PartParams::skin, {.help = "Name of a skin", .required = true});
    s.key("material", &PartParams::material, {.help = "Name of the material of the skin", .required = true});
    s.key("grooms", &PartParams::grooms,
          {.help = "Grooms on this skin, each with its material: {under: fur}"});
    s.key("poses", &PartParams::poses,
          {.help = "What this character does with the skin", .default_text = "the poses of the skin"});
    return s;
  }();
  return table;
}

const Schema<TransformParams>& TransformParams::schema() {
  static const Schema<TransformParams> table = [] {
    Schema<TransformParams> s("transform", "Where a character stands: scaled, then rotated, then moved.");
    s.key("translate", &TransformParams::translate, {.unit = "scene units", .help = "Movement"});
    s.key("rotate", &TransformParams::rotate,
          {.unit = "degrees", .help = "Rotation about x, y, z, in this order"});
    s.key("scale", &TransformParams::scale, {.help = "Uniform scale", .min = 0, .above_min = true});
    return s;
  }();
  return table;
}

const Schema<CharacterParams>& CharacterParams::schema() {
  static const Schema<CharacterParams> table = [] {
    Schema<CharacterParams> s("character", "An animal: skins with their grooms, posed and placed.");
    s.key("parts", &CharacterParams::parts, {.help = "What it is made of", .required = true});
    s.key("transform", &CharacterParams::transform,
          {.help = "Where it stands", .default_text = "at the origin"});
    s.key("frame_offset", &CharacterParams::frame_offset,
          {.unit = "frames", .help = "Added to the frame to choose the pose; may be a fraction"});
    s.key("footprint", &CharacterParams::footprint,
          {.unit = "scene units",
           .help = "Ground that it covers in a crowd: discs [x, z, radius] about its origin",
           .default_text = "its origin"});
    s.key("drawn", &CharacterParams::drawn,
          {.help = "Whether it stands in the picture by itself",
           .default_text = "unless a crowd is made of it"});
    return s;
  }();
  return table;
}

const Schema<SceneDescription>& SceneDescription::schema() {
  static const Schema<SceneDescription> table = [] {
    Schema<SceneDescription> s(
        "scene",
        "A scene is a YAML file: right-handed, y up, the camera looks along -z of its own space. Relative "
        "paths are relative to the file that names them. `include: base.yaml`, or a list of files, reads "
        "other scene files first; maps are merged and the including file wins. A number or vector marked "
        "\"or keys\" may be `{keys: {1: a, 48: b}}`, linear between frames. A field is a number, a colour or "
        "one of the blocks that end in \"field\". `--set a.b.c=value` on the command line overrides any "
        "value; an item of a list is addressed by its index from 0 or by its only key.");
    s.key("pelage", &SceneDescription::pelage, {.help = "Version of the scene format", .required = true});
    s.key("units", &SceneDescription::units,
          {.help = "What a scene unit and a frame are", .default_text = "cm, 24 fps"});
    s.key("frames", &SceneDescription::frames, {.help = "Frames to render: 1, 1-48, 1-48x2 or 1,5,9-12"});
    s.key("camera", &SceneDescription::camera,
          {.help = "Where it is seen from", .default_text = "that of the section"});
    s.key("image", &SceneDescription::image, {.help = "The picture", .default_text = "that of the section"});
    s.key("skins", &SceneDescription::skins, {.help = "Surfaces, by name"});
    s.key("grooms", &SceneDescription::grooms, {.help = "Coats, by name"});
    s.key("materials", &SceneDescription::materials, {.help = "What skins and strands look like, by name"});
    s.key("characters", &SceneDescription::characters, {.help = "Animals, by name"});
    s.key("crowds", &SceneDescription::crowds, {.help = "Many animals from a few characters, by name"});
    s.key("lights", &SceneDescription::lights,
          {.help = "Lights, by name; each has layers of its own in the picture"});
    s.key("render", &SceneDescription::render,
          {.help = "How it is computed", .default_text = "that of the section"});
    return s;
  }();
  return table;
}

}  // namespace pelage
