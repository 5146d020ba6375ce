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
#include "geom/strands.h"
#include "post/blur_file.h"
#include "post/merge_pieces.h"
#include "post/stereo_file.h"
#include "scene/document.h"

namespace pelage {

enum class Command {
  kRender,
  kView,
  kWhy,
  kGrow,
  kMeasure,
  kCompare,
  kInfo,
  kMerge,
  kFarm,
  kConvert,
  kMotionBlur,
  kStereo,
  kRib,
  kProcedural,
  kManual
};

enum class Experiment { kBounds, kGrowth, kResidency, kSamplers, kLod, kShading, kBounces };

/// Parts of the report of `measure lod`.
inline constexpr const char* kLodParts[] = {"crowd", "detail", "wedge", "dolly"};

enum class ProgressStyle {
  kAuto,     ///< a bar on a terminal, lines elsewhere
  kBar,      ///< one line that is redrawn continuously, with the time left
  kPlain,    ///< a line from time to time, for logs
  kJson,     ///< a JSON object for each percent of progress
  kAlfred,   ///< "ALF_PROGRESS 7%" for each percent of the run, on standard output
  kTractor,  ///< "TR_PROGRESS 007%" for each percent of the run, on standard output
  kQuiet,    ///< nothing
};

/// Returns the name that --progress has for a style; nothing for kAuto and kQuiet.
std::string progress_name(ProgressStyle style);

/// The whole command line. Each command reads only the members that concern it; the other members keep their
/// defaults.
struct Options {
  Command command = Command::kManual;
  std::string input;  ///< positional argument SCENE, FILE or IN
  /// -o or argument OUT; may contain a placeholder for the frame number (world/frames.h).
  std::string output;
  /// Values of --set, followed by those of flags that set scene values, such as --frames and --memory.
  std::vector<Override> overrides;
  std::optional<std::string> stats;       ///< --stats
  std::optional<double> sample_memory_s;  ///< --sample-memory: seconds between samples
  int threads = 0;                        ///< --threads; 0: as many as are available to the process
  ProgressStyle progress = ProgressStyle::kAuto;

  PictureOptions picture;        ///< render: flags of the picture
  CheckpointOptions checkpoint;  ///< render: flags of checkpoints

  int port = 0;      ///< view: port of the server; 0: any free port
  std::string bind;  ///< view: address of the server; empty: 127.0.0.1

  int pixel_x = 0, pixel_y = 0;  ///< why: the pixel, from the upper left corner
  bool json = false;             ///< why, render --estimate: whether to print JSON

  Experiment experiment = Experiment::kBounds;  ///< measure: the experiment
  int repeat = 3;                               ///< measure: runs of each variant
  double time_limit_s = 600;                    ///< measure: a run that takes longer is stopped

  /// For `measure lod`: numbers of characters with all their hair, one run each.
  std::vector<int> characters{10, 20, 40};
  std::vector<std::string> parts;  ///< measure lod, shading: parts of the report; empty: all parts

  /// For `measure shading`: samples per pixel, one run of each variant per count.
  std::vector<int> samples{4, 16, 64};
  int reference_samples = 256;  ///< measure shading: samples per pixel of the two reference pictures

  std::vector<std::string> models;  ///< compare: --models; empty: all models

  std::string groom;     ///< grow: the only groom to grow; empty: all grooms
  bool prune = false;    ///< grow: delete the files in its cache folders that the scene does not need
  bool explain = false;  ///< grow: report for each operator in a cache whether it was stale, and why
  bool lod = false;      ///< grow: write only the strands that remain at the picture's level of detail

  std::string frames;  ///< motionblur, stereo: frame numbers to insert in file names with a placeholder
  BlurFileParams motion_blur;  ///< motionblur: its parameters
  StereoFileParams stereo;     ///< stereo: its parameters

  std::vector<std::string> pieces;  ///< merge: the files to merge
  MergeParams merge;                ///< merge: its parameters

  RibUseOptions rib_in;  ///< render, why, grow, farm: flags for RIB files that the scene reads
  RibOptions rib;        ///< rib, procedural: their flags
  FarmOptions farm;      ///< farm: its flags

  std::string section;    ///< manual: the section to print
  bool markdown = false;  ///< manual: whether to print Markdown

  std::optional<CurveBasis> basis;     ///< convert, info: curve basis, for strand files that do not state it
  std::optional<float> default_width;  ///< convert, info: width of strands, for files without widths
};

/// Parses a command line. Returns nothing when help or the version was requested, after writing that text to
/// `out`. Throws Error (kArguments) for mistakes. For an unknown command or flag, the message suggests the
/// nearest known name.
std::optional<Options> parse_options(const std::vector<std::string>& arguments, std::ostream& out);

}  // namespace pelage
