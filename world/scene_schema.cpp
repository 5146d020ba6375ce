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
    Schema<UnitsParams> s("units", "Length of a scene unit, and frame rate.");
    s.set_example(R"(units: {meters_per_unit: 0.01, fps: 24}   # one scene unit is a centimetre)");
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
    Schema<PosesParams> s(
        "poses", "Posed copies of a cage, one file per pose. Pelage interpolates linearly between poses.");
    s.set_example(R"(skins:
  rat:
    mesh: rat.obj
    poses: {files: "poses/walk.%04d.obj", first: 1, count: 12, cycle: true})");
    s.key("files", &PosesParams::files,
          {.help =
               "OBJ files with the vertices and faces of the cage in the same order, or its vertices alone; "
               "%04d, ####, $F4 or <F4> is the pose number",
           .required = true});
    s.key("first", &PosesParams::first,
          {.help = "Number of the first file, and the frame at which it applies"});
    s.key("count", &PosesParams::count, {.help = "Number of files", .required = true, .min = 1, .max = 1e6});
    s.key("frames_per_pose", &PosesParams::frames_per_pose,
          {.unit = "frames", .help = "Frames from one pose to the next", .min = 0, .above_min = true});
    s.key("cycle", &PosesParams::cycle,
          {.help = "After the last pose, start again with the first one. Otherwise the first pose also "
                   "applies before "
                   "its frame, and the last pose after its frame"});
    return s;
  }();
  return table;
}

const Schema<SkinParams>& SkinParams::schema() {
  static const Schema<SkinParams> table = [] {
    Schema<SkinParams> s("skin",
                         "A surface on which fur grows: a subdivision surface, or a mesh used as it is.");
    s.set_example(R"(skins:
  rat: {mesh: rat.obj, scheme: catmull-clark}
  scan: {mesh: scan.obj, scheme: none})");
    s.key("mesh", &SkinParams::mesh,
          {.help = "OBJ, USD (.usda) or Alembic (.abc) file of the control cage at rest. Of faces with the "
                   "same vertices, "
                   "one is kept",
           .required = true});
    s.key(
        "scheme", &SkinParams::scheme,
        {.help = "Subdivision scheme. `none` uses the polygons as they are, for dense meshes such as scans: "
                 "it splits them into triangles and interpolates normals between vertices, for strands and "
                 "for shading. For each triangle of the mesh, `none` takes about 250 bytes; `catmull-clark` "
                 "takes 4,500 to 14,000 bytes"});
    s.key("boundary", &SkinParams::boundary,
          {.help = "Whether boundary corners stay sharp (`edge-and-corner`) or are rounded like boundary "
                   "edges (`edge-only`)"});
    s.key("poses", &SkinParams::poses,
          {.help = "Posed cages; without them the skin stays at rest", .default_text = "at rest"});
    s.key("transform", &SkinParams::transform,
          {.help = "From the coordinates of the mesh and its poses to the space of the characters",
           .default_text = "as in the file"});
    return s;
  }();
  return table;
}

const Schema<PartParams>& PartParams::schema() {
  static const Schema<PartParams> table = [] {
    Schema<PartParams> s("character part", "One skin of a character, its material and its grooms.");
    s.set_example(R"(characters:
  rat:
    parts:
      - {skin: rat, material: hide, grooms: {under: fur, whiskers: fur}})");
    s.key("skin", &PartParams::skin,
          {.help = "Name of a skin", .default_text = "none: all grooms are strand files without a skin"});
    s.key("material", &PartParams::material,
          {.help = "Name of the material of the skin", .default_text = "required with a skin"});
    s.key("grooms", &PartParams::grooms,
          {.help = "Grooms on this skin with their materials: {groom: material}"});
    s.key("poses", &PartParams::poses,
          {.help = "Poses of the skin for this character", .default_text = "the poses of the skin"});
    return s;
  }();
  return table;
}

const Schema<TransformParams>& TransformParams::schema() {
  static const Schema<TransformParams> table = [] {
    Schema<TransformParams> s("transform",
                              "Placement of a character: scale first, then rotation, then translation.");
    s.set_example(R"(characters:
  rat:
    parts: [{skin: rat, material: hide}]
    transform: {translate: [0, 0, 5], rotate: [0, 90, 0], scale: 1.2})");
    s.key("translate", &TransformParams::translate, {.unit = "scene units", .help = "Translation"});
    s.key("rotate", &TransformParams::rotate,
          {.unit = "degrees", .help = "Rotation about x, then y, then z"});
    s.key("scale", &TransformParams::scale,
          {.help = "Uniform scale. To mirror a character, give its skins a `transform` with a negative scale",
           .min = 0,
           .above_min = true});
    return s;
  }();
  return table;
}

const Schema<CharacterParams>& CharacterParams::schema() {
  static const Schema<CharacterParams> table = [] {
    Schema<CharacterParams> s("character", "An animal: skins with their grooms, posed and placed.");
    s.set_example(R"(characters:
  rat:
    parts:
      - {skin: rat, material: hide, grooms: {under: fur, whiskers: fur}}
      - {skin: eyes, material: eye}
    transform: {translate: [0, 0, 5]})");
    s.key("parts", &CharacterParams::parts,
          {.help = "Skins, materials and grooms that make up the character", .required = true});
    s.key("transform", &CharacterParams::transform, {.help = "Placement", .default_text = "at the origin"});
    s.key("frame_offset", &CharacterParams::frame_offset,
          {.unit = "frames",
           .help = "Frames added to the current frame to choose the pose; may be fractional"});
    s.key(
        "footprint", &CharacterParams::footprint,
        {.unit = "scene units",
         .help = "Ground that the character covers in a crowd: discs [x, z, radius], relative to its origin",
         .default_text = "its origin"});
    s.key("drawn", &CharacterParams::drawn,
          {.help = "Whether the character appears by itself",
           .default_text = "true, or false if a crowd uses it"});
    return s;
  }();
  return table;
}

const Schema<ArchiveParams>& ArchiveParams::schema() {
  static const Schema<ArchiveParams> table = [] {
    Schema<ArchiveParams> s(
        "archive",
        "A RIB file: its curves become coats and its meshes become skins, as they are. Its "
        "camera and its lights are ignored; `pelage render shot.rib` uses them.");
    s.set_example(R"(archives:
  fox: {rib: fox.rib, transform: {translate: [0, 0, 5]}, materials: {plastic: hide}})");
    s.key("rib", &ArchiveParams::rib, {.help = "RIB file: text, binary or compressed", .required = true});
    s.key("transform", &ArchiveParams::transform, {.help = "Placement", .default_text = "at the origin"});
    s.key(
        "materials", &ArchiveParams::materials,
        {.help = "Materials for the surfaces of the file: {surface: material}. The name of a surface is the "
                 "parameter \"name\" of its shader, or the name of the shader. Other surfaces get a "
                 "material ARCHIVE.SURFACE with the values of the file"});
    return s;
  }();
  return table;
}

const Schema<SceneDescription>& SceneDescription::schema() {
  static const Schema<SceneDescription> table = [] {
    Schema<SceneDescription> s(
        "scene",
        "A scene is a YAML file. Coordinates are right-handed with y up; the camera looks along -z of its "
        "own space. Relative paths start at the folder of the file that contains them. `include: base.yaml`, "
        "or a list of files, reads other scene files first; maps are merged, and the including file "
        "overrides the included ones. A number or vector marked \"or keys\" may be `{keys: {1: a, 48: b}}`, "
        "which interpolates linearly between frames. A field is a number, a colour or one of the blocks "
        "whose names end in \"field\". `--set a.b.c=value` on the command line overrides any value, and "
        "`--set a.b.c=null` removes it; a list item is addressed by its index from 0, or, if the item is a "
        "map "
        "with a single key, by that key. A key marked \"formerly\" also accepts its old name, with a "
        "warning; "
        "giving both names in one file or override is an error.");
    s.set_example(R"(pelage: 1
include: [animals.yaml, lights.yaml]
frames: 1-48
camera: {position: {keys: {1: [0, 12, 60], 48: [0, 12, 30]}}, look_at: [0, 9, 0], fov: 24})");
    s.key("pelage", &SceneDescription::pelage, {.help = "Version of the scene format", .required = true});
    s.key("units", &SceneDescription::units,
          {.help = "Length of a scene unit, and frame rate", .default_text = "cm, 24 fps"});
    s.key("frames", &SceneDescription::frames, {.help = "Frames to render: 1, 1-48, 1-48x2 or 1,5,9-12"});
    s.key("camera", &SceneDescription::camera,
          {.help = "Position, direction and shutter of the camera", .default_text = "see camera"});
    s.key("image", &SceneDescription::image,
          {.help = "Size and layers of the picture", .default_text = "see image"});
    s.key("skins", &SceneDescription::skins, {.help = "Surfaces on which fur grows, by name"});
    s.key("regions", &SceneDescription::regions,
          {.help =
               "Fields, by name, which any field may use as `{region: NAME}`: in a mask, a density, a value "
               "of an operator or material, or another region. A region means the same on every skin"});
    s.key("grooms", &SceneDescription::grooms, {.help = "Coats, by name"});
    s.key("materials", &SceneDescription::materials,
          {.help = "Materials of skins and strands, by name. For strands, `preset` may replace "
                   "`model`: it gives the hair of an animal, with the names of `preset` of a groom"});
    s.key("characters", &SceneDescription::characters, {.help = "Animals, by name"});
    s.key("crowds", &SceneDescription::crowds,
          {.help = "Groups of many animals made from a few characters, by name"});
    s.key("archives", &SceneDescription::archives,
          {.help = "RIB files that are rendered with the scene, by name"});
    s.key("lights", &SceneDescription::lights,
          {.help = "Lights, by name; each adds its own layers to the picture"});
    s.key("magnets", &SceneDescription::magnets,
          {.help = "Shapes that attract rays, by name: they reduce the noise of rooms that are lit through a "
                   "window"});
    s.key("render", &SceneDescription::render,
          {.help = "Rendering method, quality and limits", .default_text = "see render"});
    return s;
  }();
  return table;
}

}  // namespace pelage
