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

enum class Experiment { kAccel, kBounds, kGrowth, kResidency, kSamplers, kLod };

/// Parts of the report of `measure lod`.
inline constexpr const char* kLodParts[] = {"crowd", "detail", "wedge", "dolly"};

enum class ProgressStyle {
  kAuto,   ///< a bar on a terminal, lines elsewhere
  kBar,    ///< one line that is drawn again and again, with the time left
  kPlain,  ///< a line now and then, for logs
  kJson,   ///< a JSON object per percent
  kQuiet,  ///< nothing
};

/// The whole command line as one value. Commands read what concerns them; the rest has its default.
struct Options {
  Command command = Command::kManual;
  std::string input;   ///< SCENE, FILE or IN
  std::string output;  ///< -o or OUT; may hold a place for the frame number (world/frames.h)
  std::vector<Override>
      overrides;  ///< --set, then the flags that stand for scene values (--frames, --memory)
  std::optional<std::string> stats;       ///< --stats
  std::optional<double> sample_memory_s;  ///< --sample-memory: seconds between two samples
  int threads = 0;                        ///< --threads; 0: all that the process may use
  ProgressStyle progress = ProgressStyle::kAuto;

  Experiment experiment = Experiment::kBounds;  ///< measure
  int repeat = 3;                               ///< measure: runs of each variant
  double time_limit_s = 600;                    ///< measure: a run that takes longer is ended

  std::vector<int> characters{10, 20, 40};  ///< measure lod: how many of a crowd keep every hair
  std::vector<std::string> parts;           ///< measure lod: of the report; empty: all

  int rays = 1 << 17;                    ///< measure accel, trace: of each kind, at most
  std::string trace_variant = "fur-64";  ///< trace: LabVariant::names()
  double trace_share = 1;                ///< trace: memory of `paged` over the size of its tree
  std::vector<std::string> trace_kinds;  ///< trace: of rays; empty: all

  std::vector<std::string> models;  ///< compare: --models; empty: all

  std::string groom;     ///< grow: only this one; empty: all
  bool prune = false;    ///< grow: remove what the scene does not need from the folders of its caches
  bool explain = false;  ///< grow: say of each operator whether its cache was fresh
  bool lod = false;      ///< grow: write the strands that the picture needs at its level of detail, not all

  std::string frames;          ///< motionblur, stereo: --frames, for names with a place for the number
  BlurFileParams motion_blur;  ///< motionblur
  StereoFileParams stereo;     ///< stereo

  std::string section;    ///< manual
  bool markdown = false;  ///< manual

  std::optional<CurveBasis> basis;     ///< convert, info: of strand files that do not say
  std::optional<float> default_width;  ///< convert, info: of strand files without widths
};

/// Reads a command line. Returns nothing when help or the version was asked for, which then stands in `out`.
/// Throws Error (kArguments) with the nearest known name for unknown commands and flags.
std::optional<Options> parse_options(const std::vector<std::string>& arguments, std::ostream& out);

}  // namespace pelage
