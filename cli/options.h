// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

#include "geom/strands.h"
#include "post/blur_file.h"
#include "post/stereo_file.h"
#include "scene/document.h"

namespace pelage {

enum class Command {
  kRender,
  kGrow,
  kMeasure,
  kTrace,
  kCompare,
  kInfo,
  kConvert,
  kMotionBlur,
  kStereo,
  kManual
};

enum class Experiment { kAccel, kBounds, kGrowth, kResidency, kSamplers, kLod, kShading };

/// Parts of the report of `measure lod`.
inline constexpr const char* kLodParts[] = {"crowd", "detail", "wedge", "dolly"};

enum class ProgressStyle {
  kAuto,   ///< a bar on a terminal, lines elsewhere
  kBar,    ///< one line that is redrawn continuously, with the time left
  kPlain,  ///< an occasional line, for logs
  kJson,   ///< a JSON object per percent
  kQuiet,  ///< nothing
};

/// The whole command line as one value. Commands read the members that concern them; the others keep their
/// defaults.
struct Options {
  Command command = Command::kManual;
  std::string input;   ///< SCENE, FILE or IN
  std::string output;  ///< -o or OUT; may contain a placeholder for the frame number (world/frames.h)
  std::vector<Override> overrides;   ///< --set, then the flags that set scene values (--frames, --memory)
  std::optional<std::string> stats;  ///< --stats
  std::optional<double> sample_memory_s;  ///< --sample-memory: seconds between samples
  int threads = 0;                        ///< --threads; 0: as many as the process may use
  ProgressStyle progress = ProgressStyle::kAuto;

  Experiment experiment = Experiment::kBounds;  ///< measure
  int repeat = 3;                               ///< measure: runs of each variant
  double time_limit_s = 600;                    ///< measure: a run that takes longer is killed

  std::vector<int> characters{10, 20, 40};  ///< measure lod: numbers of characters with all their hair
  std::vector<std::string> parts;           ///< measure lod, shading: parts of the report; empty: all

  std::vector<int> samples{4, 16, 64};  ///< measure shading: sample counts of each variant
  int reference_samples = 256;          ///< measure shading

  int rays = 1 << 17;                    ///< measure accel, trace: max number of each kind
  std::string trace_variant = "fur-64";  ///< trace: LabVariant::names()
  double trace_share = 1;                ///< trace: memory of `paged` relative to the size of its tree
  std::vector<std::string> trace_kinds;  ///< trace: kinds of rays; empty: all

  std::vector<std::string> models;  ///< compare: --models; empty: all

  std::string groom;     ///< grow: only this groom; empty: all
  bool prune = false;    ///< grow: remove files that the scene does not need from its cache folders
  bool explain = false;  ///< grow: report for each operator whether its cache was fresh
  bool lod = false;      ///< grow: write only the strands that the picture needs at its level of detail

  std::string frames;          ///< motionblur, stereo: --frames, for names with a placeholder for the number
  BlurFileParams motion_blur;  ///< motionblur
  StereoFileParams stereo;     ///< stereo

  std::string section;    ///< manual
  bool markdown = false;  ///< manual

  std::optional<CurveBasis> basis;     ///< convert, info: for strand files that do not state it
  std::optional<float> default_width;  ///< convert, info: for strand files without widths
};

/// Parses a command line. Empty when help or the version was requested, which is then written to `out`.
/// Throws Error (kArguments) with the nearest known name for unknown commands and flags.
std::optional<Options> parse_options(const std::vector<std::string>& arguments, std::ostream& out);

}  // namespace pelage
