// SPDX-License-Identifier: Apache-2.0
#include "cli/options.h"

#include <algorithm>
#include <limits>
#include <map>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <fmt/format.h>

#include "base/nearest_name.h"
#include "cli/command_line.h"
#include "cli/common_flags.h"
#include "cli/exchange_flags.h"
#include "cli/lab_program.h"
#include "cli/number_checks.h"
#include "cli/post_flags.h"
#include "cli/rib_flags.h"
#include "groom/strands/curve_basis_names.h"
#include "starter/animal_coat.h"
#include "starter/coat_look.h"

namespace pelage {
namespace {

/// Values of flags that the parser leaves as text until they are validated, so that all messages are our own.
struct Texts : RunTexts {
  std::string basis;
  std::vector<std::string> section;  // its words
  PostTexts post;
  PictureTexts picture;
  std::string checkpoint_every;
  FarmTexts farm;
  std::string export_format;
  std::string host;
};

void add_file_memory_flag(CLI::App& command, Texts& texts) {
  command.add_option("--memory", texts.memory, "Memory limit for the contents of the file (default: 4G)")
      ->type_name("BYTES");
}

void add_strand_flags(CLI::App& command, Options& options, Texts& texts) {
  command
      .add_option("--basis", texts.basis,
                  "Curve basis of a strand file: " + ValueReader<CurveBasis>::type_name())
      ->type_name("BASIS");
  command.add_option("--default-width", options.default_width, "Strand width if the file has none")
      ->check(positive_number())
      ->type_name("WIDTH");
}

void add_render(CLI::App& app, Options& options, Texts& texts) {
  CLI::App* render = app.add_subcommand("render", "Render a scene to EXR, PNG or JPEG files");
  add_scene_flags(*render, options, texts);
  add_rib_use_flags(*render, options.rib_in);
  add_script_flag(*render, options);
  render
      ->add_option("-o,--output", options.output,
                   "Output file (default: the scene's name and .exr); .png and .jpg hold the beauty as a "
                   "screen shows it; %04d is the frame number")
      ->type_name("FILE.%04d.exr");
  render->add_option("--frames", texts.frames, "Frames: 1-48, 1-48x2 or 1,5,9-12")->type_name("FRAMES");
  add_picture_flags(*render, options.picture, texts.picture);
  CLI::Option* estimate =
      render->add_flag("--estimate", options.picture.estimate,
                       "Render nothing; print the memory and, roughly, the time that each frame takes");
  render->add_flag("--json", options.json, "Print the estimate as JSON")->needs(estimate);
  add_checkpoint_flags(*render, options.checkpoint, texts.checkpoint_every);
  add_run_flags(*render, options, texts);
  add_cache_flags(*render, texts);
}

void add_view(CLI::App& app, Options& options, Texts& texts) {
  CLI::App* view = app.add_subcommand(
      "view", "Show a picture in the browser that refines while you look and follows the scene's files");
  add_scene_flags(*view, options, texts);
  add_script_flag(*view, options);
  view->add_option("--port", options.port, "Port of the page (default: any free port)")
      ->check(CLI::Range(1, 65535))
      ->type_name("N");
  view->add_option("--bind", options.bind,
                   "Address of the page (default: 127.0.0.1, which only this machine can reach)")
      ->type_name("ADDRESS");
  view->add_option("--threads", options.threads, "Number of threads (default: all available)")
      ->check(CLI::Range(0, 4096))
      ->type_name("N");
  view->add_option("--memory", texts.memory, kMemoryHelp)->type_name("BYTES");
  add_cache_flags(*view, texts);
}

void add_why(CLI::App& app, Options& options, Texts& texts) {
  CLI::App* why = app.add_subcommand("why", "Explain a pixel: its strand, material, light and cost");
  add_scene_flags(*why, options, texts);
  add_rib_use_flags(*why, options.rib_in);
  add_script_flag(*why, options);
  why->add_option("X", options.pixel_x, "Column of the pixel; 0 is the leftmost")
      ->required()
      ->check(whole_number());
  why->add_option("Y", options.pixel_y, "Row of the pixel; 0 is the top")->required()->check(whole_number());
  why->add_flag("--json", options.json, "Print JSON");
  why->add_option(
         "-o,--output", options.output,
         "Picture to write (.png, .jpg): the surroundings of the pixel, with its strand drawn over them")
      ->type_name("FILE.png");
  why->add_option("--frames", texts.frames, "Frame of the pixel (default: the scene's first)")
      ->type_name("FRAME");
  add_parallel_flags(*why, options, texts, kMemoryHelp);
  add_cache_flags(*why, texts);
}

void add_simulate(CLI::App& app, Options& options, Texts& texts) {
  CLI::App* simulate = app.add_subcommand(
      "simulate", "Simulate the motion of coats with `dynamics` and store it for the other commands");
  add_scene_flags(*simulate, options, texts);
  add_rib_use_flags(*simulate, options.rib_in);
  add_script_flag(*simulate, options);
  simulate
      ->add_option("--frames", texts.frames,
                   "Frames to make: 1-48. Earlier frames are read or simulated first")
      ->type_name("FRAMES");
  CLI::Option* file = simulate
                          ->add_option("-o,--output", options.output,
                                       "Also write the guides of one coat, in world space: one file per "
                                       "frame, such as guides.%04d.hair, for `dynamics: {files: ...}`. "
                                       "Format by its extension: .hair, .tfx, .usda or .abc")
                          ->type_name("FILE");
  simulate->add_option("--groom", options.groom, "Simulate only this groom, and write its guides with -o")
      ->type_name("NAME");
  simulate
      ->add_flag("--as-groomed", options.as_groomed,
                 "With -o, simulate nothing: write the guides as groomed, carried by their skin")
      ->needs(file);
  simulate->add_flag("--explain", options.explain,
                     "List everything that determines the motion of each coat, and what has changed");
  simulate->add_flag("--prune", options.prune,
                     "Delete stored motion that the scene does not need up to the last of these frames and "
                     "that no run has used for an hour");
  add_run_flags(*simulate, options, texts);
  add_cache_flags(*simulate, texts);
}

void add_grow(CLI::App& app, Options& options, Texts& texts) {
  CLI::App* grow = app.add_subcommand(
      "grow", "Fill the caches of a scene (strand offsets, bounding boxes) or write strand files");
  add_scene_flags(*grow, options, texts);
  add_rib_use_flags(*grow, options.rib_in);
  add_script_flag(*grow, options);
  CLI::Option* file =
      grow->add_option(
              "-o,--output", options.output,
              "Strand file to write (.hair, .tfx, .usda or .abc): all strands. With a place for the frame "
              "number, one file per frame: coat.%04d.hair")
          ->type_name("FILE");
  grow->add_flag("--lod", options.lod,
                 "Write only the strands that remain at the picture's level of detail (render.lod)")
      ->needs(file);
  grow->add_option("--groom", options.groom, "Grow only this groom")->type_name("NAME");
  grow->add_flag("--explain", options.explain,
                 "For each operator in a cache, say whether it was stale and why");
  grow->add_flag("--prune", options.prune,
                 "Delete cache files that no groom of the scene needs and that no run has used for an hour, "
                 "and all files of the user's cache of growth");
  grow->add_option(
          "--frames", texts.frames,
          "Frames to compute bounding boxes for; strands grow at the first frame, or at all frames if -o "
          "has a place for the frame number")
      ->type_name("FRAMES");
  add_run_flags(*grow, options, texts);
  add_cache_flags(*grow, texts);
}

void add_info(CLI::App& app, Options& options, Texts& texts) {
  CLI::App* info = app.add_subcommand("info", "Describe a scene, strand file, mesh, EXR or cache file");
  info->add_option("FILE", options.input,
                   "A .yaml, .rib, .hair, .tfx, .usda, .abc, .obj, .exr or .cache file")
      ->required();
  info->add_option("--set", texts.set, "Override a scene value: a.b.c=value; repeatable")
      ->allow_extra_args(false)
      ->type_name("KEY=VALUE");
  add_strand_flags(*info, options, texts);
  add_file_memory_flag(*info, texts);
}

void add_convert(CLI::App& app, Options& options, Texts& texts) {
  CLI::App* convert =
      app.add_subcommand("convert", "Convert between strand formats (.hair, .tfx, .usda, .abc)");
  convert->add_option("IN", options.input, "Strand file to read")->required();
  convert->add_option("OUT", options.output, "Strand file to write")->required();
  add_host_flag(*convert, texts.host);
  add_strand_flags(*convert, options, texts);
  add_file_memory_flag(*convert, texts);
}

void add_validate(CLI::App& app, Options& options, Texts& texts) {
  CLI::App* validate = app.add_subcommand(
      "validate",
      "Check a strand file for what other programs stumble over; exits with 3 if there is a problem");
  validate->add_option("FILE", options.input, "A .usda, .abc, .hair or .tfx file")->required();
  add_strand_flags(*validate, options, texts);
}

void add_post(CLI::App& app, Options& options, Texts& texts) {
  constexpr const char* kPostMemory = "Memory limit for pixels and work buffers (default: 4G)";
  CLI::App* motion_blur =
      app.add_subcommand("motionblur", "Blur a rendered picture along its motion vectors (any EXR)");
  add_motion_blur_flags(*motion_blur, options, texts.post);
  add_run_flags(*motion_blur, options, texts, kPostMemory);

  CLI::App* stereo =
      app.add_subcommand("stereo", "Make the second eye's picture from the first eye's (any EXR)");
  add_stereo_flags(*stereo, options, texts.post);
  add_run_flags(*stereo, options, texts, kPostMemory);
}

void add_merge(CLI::App& app, Options& options, Texts& texts) {
  CLI::App* merge = app.add_subcommand("merge", "Join the regions of a picture that 'render --region' made");
  merge->add_option("PIECE", options.pieces, "EXR files that together cover the picture once")->required();
  merge->add_option("-o,--output", options.output, "EXR file to write")->required()->type_name("FILE.exr");
  merge->add_flag("--any-instructions", options.merge.any_instructions,
                  "Accept pieces that processors with different instructions rendered");
  add_thread_flags(*merge, options, texts);
}

void add_rib(CLI::App& app, Options& options, Texts& texts) {
  CLI::App* rib = app.add_subcommand("rib", "Write a scene as RIB for a RenderMan-compliant renderer");
  add_scene_flags(*rib, options, texts);
  add_script_flag(*rib, options);
  rib->add_option("-o,--output", options.output,
                  "File to write (.rib, or .rib.gz for a compressed file); %04d is the frame number")
      ->required()
      ->type_name("FILE.rib");
  rib->add_option("--frames", texts.frames, "Frames: 1-48, 1-48x2 or 1,5,9-12")->type_name("FRAMES");
  add_rib_flags(*rib, options.rib);
  add_run_flags(*rib, options, texts);

  add_procedural_flags(
      *app.add_subcommand("procedural", "Answer requests of RunProgram on standard input with RIB"),
      options.rib);
}

void add_export(CLI::App& app, Options& options, Texts& texts) {
  CLI::App* command =
      app.add_subcommand("export", "Write a scene for other programs: USD, pbrt-v4, Mitsuba 3 or Alembic");
  add_scene_flags(*command, options, texts);
  add_rib_use_flags(*command, options.rib_in);
  add_script_flag(*command, options);
  add_export_flags(*command, options.output, texts.export_format);
  command->add_option("--frames", texts.frames, "Frames: 1-48, 1-48x2 or 1,5,9-12")->type_name("FRAMES");
  add_run_flags(*command, options, texts);
  add_cache_flags(*command, texts);
}

void add_farm(CLI::App& app, Options& options, Texts& texts) {
  CLI::App* farm = app.add_subcommand(
      "farm", "Divide a shot into tasks for the queue of a render farm; run them on Slurm");
  add_farm_flags(*farm, options.farm, texts.farm);
  add_scene_flags(*farm, options, texts, "Scene file; for status and cancel, the folder of the shot (--dir)");
  add_rib_use_flags(*farm, options.rib_in);
  add_script_flag(*farm, options);
  farm->add_option("-o,--output", options.output, "Output file; %04d is the frame number")
      ->type_name("FILE.%04d.exr");
  farm->add_option("--frames", texts.frames, "Frames: 1-48, 1-48x2 or 1,5,9-12")->type_name("FRAMES");
  add_parallel_flags(*farm, options, texts, "Memory budget of each task, such as 512M or 4G");
}

void add_manual(CLI::App& app, Options& options, Texts& texts) {
  CLI::App* manual = app.add_subcommand("manual", "Print every scene key with type, default, unit and range");
  manual->add_option("SECTION", texts.section, "Print only this section, such as camera, curl or map field");
  manual->add_flag("--markdown", options.markdown, "Write Markdown");
}

void add_new(CLI::App& app, Options& options) {
  std::string presets;
  for (const CoatLook& look : coat_looks())
    presets += fmt::format("{}{} ({})", presets.empty() ? "" : ", ", look.name, look.help);
  CLI::App* command = app.add_subcommand(
      "new", "Write a first scene for a mesh: a coat, lights and a camera that suit its size and axes");
  command->add_option("MESH", options.input, "OBJ, USD (.usda) or Alembic (.abc) file of the animal")
      ->required();
  command->add_option("-o,--output", options.output, "Scene file to write")
      ->required()
      ->type_name("FUR.yaml");
  command
      ->add_option("--preset", options.starter.preset,
                   "Coat: " + presets + " (default: the first); or of an animal: " + animal_names())
      ->type_name("NAME");
  command
      ->add_option("--facing", options.starter.facing,
                   "Where the head is: x, -x, y, -y, z or -z (default: guessed from the mesh)")
      ->type_name("AXIS");
  command->add_option("--up", options.starter.up, "Where the back or the top is (default: guessed, mostly y)")
      ->type_name("AXIS");
  command->add_option("--strands", options.starter.strands, "Number of strands (default: the preset's)")
      ->check(CLI::Range(1, 500'000'000))
      ->type_name("N");
  command->add_flag("--force", options.starter.force, "Replace an existing scene file");
  command->footer(
      "Example:\n  pelage new cow.obj -o fur.yaml --preset long\n  pelage render fur.yaml -o fur.png "
      "--preview");
}

void add_commands(CLI::App& app, Options& options, Texts& texts) {
  add_new(app, options);
  add_render(app, options, texts);
  add_view(app, options, texts);
  add_why(app, options, texts);
  add_grow(app, options, texts);
  add_simulate(app, options, texts);
  for (const LabCommand& command : lab_commands()) app.add_subcommand(command.name, command.help);
  add_info(app, options, texts);
  add_merge(app, options, texts);
  add_rib(app, options, texts);
  add_export(app, options, texts);
  add_farm(app, options, texts);
  add_convert(app, options, texts);
  add_validate(app, options, texts);
  add_post(app, options, texts);
  add_manual(app, options, texts);
}

const std::map<std::string, Command>& command_names() {
  static const std::map<std::string, Command> names{
      {"new", Command::kNew},           {"render", Command::kRender},
      {"view", Command::kView},         {"why", Command::kWhy},
      {"grow", Command::kGrow},         {"simulate", Command::kSimulate},
      {"info", Command::kInfo},         {"merge", Command::kMerge},
      {"farm", Command::kFarm},         {"convert", Command::kConvert},
      {"validate", Command::kValidate}, {"motionblur", Command::kMotionBlur},
      {"stereo", Command::kStereo},     {"rib", Command::kRib},
      {"export", Command::kExport},     {"procedural", Command::kProcedural},
      {"manual", Command::kManual}};
  return names;
}

CurveBasis parse_basis(const std::string& text) {
  const std::vector<std::string> names(std::begin(EnumNames<CurveBasis>::names),
                                       std::end(EnumNames<CurveBasis>::names));
  const auto found = std::find(names.begin(), names.end(), text);
  if (found == names.end()) fail_arguments("--basis " + quote(text) + " is not known" + suggest(text, names));
  return static_cast<CurveBasis>(found - names.begin());
}

void interpret(const Texts& texts, Options& options) {
  interpret_run(texts, options);
  if (!texts.memory.empty()) {
    const auto bytes =
        static_cast<int64_t>(std::min<uint64_t>(*parse_bytes(texts.memory), uint64_t{1} << 60));
    options.motion_blur.file.memory = options.stereo.file.memory = bytes;
    // No limit, like `render.memory: 0`.
    options.memory = bytes > 0 ? bytes : std::numeric_limits<int64_t>::max();
  }
  interpret_picture(texts.picture, options);
  interpret_checkpoint(texts.checkpoint_every, options.checkpoint);
  options.export_format = interpret_export(texts.export_format);
  options.host = interpret_host(texts.host);
  interpret_farm(texts.farm, options.output, options.farm);
  for (const std::string& word : texts.section)
    options.section += (options.section.empty() ? "" : " ") + word;
  if (!texts.basis.empty()) options.basis = parse_basis(texts.basis);
  interpret_post(texts.post, options);
}

}  // namespace

std::optional<Options> parse_options(const std::vector<std::string>& arguments, std::ostream& out) {
  Options options;
  Texts texts;
  const auto app =
      make_parser("Pelage grows fur on demand and renders it.", "pelage",
                  "'pelage COMMAND --help' explains a command; 'pelage manual' explains the scene file.");
  add_commands(*app, options, texts);
  if (!parse_command_line(*app, arguments, out)) return {};
  options.command = command_names().at(arguments[0]);
  interpret(texts, options);
  constexpr Command kWithCache[] = {Command::kRender, Command::kView,     Command::kWhy,
                                    Command::kGrow,   Command::kSimulate, Command::kExport};
  options.cache = !texts.no_cache && std::find(std::begin(kWithCache), std::end(kWithCache),
                                               options.command) != std::end(kWithCache);
  return options;
}

}  // namespace pelage
