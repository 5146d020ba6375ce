// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

#include "cli/checkpoint_flags.h"
#include "cli/farm_flags.h"
#include "cli/picture_flags.h"
#include "cli/rib_flags.h"
#include "cli/run_options.h"
#include "exchange/scene_export.h"
#include "geom/alembic/alembic_curves_writer.h"
#include "geom/strands.h"
#include "post/blur_file.h"
#include "post/merge_pieces.h"
#include "post/stereo_file.h"

namespace pelage {

enum class Command {
  kNew,
  kRender,
  kView,
  kWhy,
  kGrow,
  kSimulate,
  kInfo,
  kMerge,
  kFarm,
  kConvert,
  kValidate,
  kMotionBlur,
  kStereo,
  kRib,
  kExport,
  kProcedural,
  kManual
};

/// Flags of `new`. Empty texts and 0: not given.
struct StarterOptions {
  std::string preset, facing, up;
  int strands = 0;
  bool force = false;  ///< replace an existing scene
};

/// The whole command line. Each command reads only the members that concern it; the other members keep their
/// defaults.
struct Options : RunOptions {
  Command command = Command::kManual;
  PictureOptions picture;        ///< render: flags of the picture
  CheckpointOptions checkpoint;  ///< render: flags of checkpoints

  int port = 0;      ///< view: port of the server; 0: any free port
  std::string bind;  ///< view: address of the server; empty: 127.0.0.1

  int pixel_x = 0, pixel_y = 0;  ///< why: the pixel, from the upper left corner
  bool json = false;             ///< why, render --estimate: whether to print JSON

  std::string groom;   ///< grow, simulate: the only groom to grow or to simulate; empty: all grooms
  bool prune = false;  ///< grow, simulate: delete the files in its cache folders that the scene does not need
  bool explain = false;     ///< grow, simulate: report what was stale in a cache, and why
  bool as_groomed = false;  ///< simulate: write the guides as groomed, without a simulation
  bool lod = false;         ///< grow: write only the strands that remain at the picture's level of detail

  std::string frames;  ///< motionblur, stereo: frame numbers to insert in file names with a placeholder
  BlurFileParams motion_blur;  ///< motionblur: its parameters
  StereoFileParams stereo;     ///< stereo: its parameters

  std::vector<std::string> pieces;  ///< merge: the files to merge
  MergeParams merge;                ///< merge: its parameters

  StarterOptions starter;  ///< new: its flags

  RibOptions rib;                                   ///< rib, procedural: their flags
  ExportFormat export_format = ExportFormat::kUsd;  ///< export: the format
  FarmOptions farm;                                 ///< farm: its flags

  std::string section;    ///< manual: the section to print
  bool markdown = false;  ///< manual: whether to print Markdown

  int64_t memory = int64_t{4} << 30;  ///< convert, info: max memory for the contents of a file, in bytes

  AlembicHost host = AlembicHost::kAny;  ///< convert: the program that an .abc file is made for

  std::optional<CurveBasis> basis;     ///< convert, info: curve basis, for strand files that do not state it
  std::optional<float> default_width;  ///< convert, info: width of strands, for files without widths
};

/// Parses a command line. Returns nothing when help or the version was requested, after writing that text to
/// `out`. Throws Error (kArguments) for mistakes. For an unknown command or flag, the message suggests the
/// nearest known name.
std::optional<Options> parse_options(const std::vector<std::string>& arguments, std::ostream& out);

}  // namespace pelage
