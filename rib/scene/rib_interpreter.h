// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "rib/scene/rib_batches.h"
#include "rib/scene/rib_mesh_reader.h"
#include "rib/scene/rib_programs.h"
#include "rib/scene/rib_reading.h"
#include "rib/scene/rib_scene.h"
#include "rib/syntax/rib_basis.h"
#include "rib/syntax/rib_parameters.h"

namespace pelage {

/// The nodes of the request Pattern, by their handles.
using RibPatterns = std::map<std::string, std::shared_ptr<const RibShader>>;

/// What AttributeBegin saves: the transform and the attributes [RISPEC 3.2, graphics state].
struct RibAttributes {
  RibTransform to_world;  ///< before WorldBegin: to camera space
  Rgb color{1};
  float opacity = 1;             ///< mean of the channels of Opacity
  Rgb tint{1};                   ///< Attribute "pelage" "tint"
  bool chaikin_creases = false;  ///< Attribute "pelage" "chaikin"
  bool bilinear = false;         ///< Attribute "pelage" "scheme" "bilinear": polygons are bilinear surfaces
  bool seen_by_camera = true;    ///< Attribute "visibility" "camera"
  std::shared_ptr<const RibShader> surface;  ///< Surface or Bxdf
  std::shared_ptr<RibPatterns> patterns = std::make_shared<RibPatterns>();
  RibBasis basis_u = *RibBasis::named("bezier"), basis = basis_u;  ///< curves have the second one, for v
  std::string name;                                                ///< Attribute "identifier" "name"
  std::shared_ptr<const RibShader> area;  ///< AreaLightSource; null for things that are not lights
};

/// The state in which a deferred archive is read.
struct RibContext {
  RibAttributes attributes;
  RibDeclarations declarations;
  std::map<std::string, RibTransform> spaces;
  std::vector<std::string> search_path;   ///< of archives
  std::vector<std::string> program_path;  ///< of procedurals
  std::vector<std::string> texture_path;
  std::filesystem::path folder;  ///< of the file that was given first
  RibShutter shutter;
  RibTransform world;                        ///< from the world of the file to the world of the scene
  std::map<std::string, uint64_t> next_ids;  ///< of strands without ids, by coat
  double time_base = 0;                      ///< subtracted from the times of the file
};

/// The batches of a deferred archive, in the order in which they are completed.
struct RibDeferredArchive {
  std::filesystem::path path;
  RibContext context;
  size_t request_bytes = 0;               ///< memory of its largest request
  std::shared_ptr<const RibReply> reply;  ///< if `path` is the reply of a program: keeps the file
  /// Reads one batch again. Throws Error (kInput) if the file has changed.
  Strands read(size_t batch, const StrandCounts& expected) const;
};

struct RibCurveSet;

/// Executes the requests of RIB files. One instance reads one frame; all requests change its state or add to
/// the scene.
class RibInterpreter {
 public:
  RibInterpreter(const RibReadOptions& options, RibContext context);
  RibInterpreter(const RibInterpreter&) = delete;
  RibInterpreter& operator=(const RibInterpreter&) = delete;

  /// Reads a file, and the files that it names. `named_at`: request that names it; null for the first file.
  void read_file(const std::filesystem::path& path, const RibStatement* named_at);
  /// Ends the frame: completes batches, and checks that all blocks are closed.
  void finish();
  RibScene& scene() { return scene_; }
  /// Returns whether all worlds were skipped because they draw shadow maps.
  bool is_shadow_pass() const { return !world_done_ && !any_picture_ && skipped_shadows_; }

  /// Deferred archives: calls `take` instead of keeping strands.
  void set_take(RibBatches::Take take) {
    take_ = std::move(take);
    in_deferred_ = true;
  }
  /// Ignores all further requests.
  void stop() { stopped_ = true; }

 private:
  /// A request, or the samples of a request in a motion block.
  struct Call {
    std::span<RibStatement> samples;
    std::vector<double> times;  // empty outside of motion blocks
    RibStatement& request() const { return samples.front(); }
  };
  using Handler = void (RibInterpreter::*)(const Call&);
  struct Block {
    std::string name;  // "Attribute"
    std::string file;
    int line = 0, column = 0;
    RibAttributes saved;
  };
  static Handler handler(const std::string& name);
  static Handler state_handler(const std::string& name);
  static Handler content_handler(const std::string& name);

  void execute(RibStatement& request);
  bool record(const RibStatement& request);
  bool skip(const RibStatement& request);
  void dispatch(const Call& call);
  void warn_once(const std::string& kind, const SourcePosition& position, const std::string& message);
  /// Counts things that are dropped; finish() warns of each kind once, with its count.
  void drop(const std::string& what, const SourcePosition& position, size_t count);
  void warn_undeclared(const RibStatement& request, const std::vector<std::string>& parameters);
  void skipped(const RibStatement& request);
  void keep(const RibStatement& request, std::vector<RibStatement>& list);
  void allow_request(const RibStatement& request, size_t bytes);

  // blocks (rib_blocks.cpp)
  void begin_block(const Call& call);
  void end_block(const Call& call);
  void begin_frame(const Call& call);
  void end_frame();
  void begin_world(const Call& call);
  void begin_motion(const Call& call);
  void end_motion(const Call& call);
  void begin_object(const Call& call);
  void instance(const Call& call);

  // attributes (rib_attribute_requests.cpp)
  void transform(const Call& call);
  void set_transform(const Call& call);
  void coordinate_system(const Call& call);
  void use_coordinate_system(const Call& call);
  void color(const Call& call);
  void opacity(const Call& call);
  void surface(const Call& call);
  void basis(const Call& call);
  static RibBasis basis_of(const RibStatement& request, const RibOperand& basis, const RibOperand& step);
  void attribute(const Call& call);
  void declare(const Call& call);
  std::shared_ptr<const RibShader> shader_of(RibStatement& request, size_t parameters);
  std::vector<RibSetting> settings_of(RibStatement& request, size_t parameters);

  // nodes of RIS (rib_node_requests.cpp)
  void bxdf(const Call& call);
  void pattern(const Call& call);
  std::optional<RibSetting> value_of(const RibSetting& reference, int depth = 0) const;

  // lights (rib_light_requests.cpp)
  void light_source(const Call& call);
  void area_light_source(const Call& call);
  void ris_light(const Call& call);
  void add_light(RibLight light);
  void find_map(RibLight& light, const RibStatement& request);
  void move_lights_to_world();

  // camera and options (rib_camera_requests.cpp)
  void projection(const Call& call);
  void named_camera(const Call& call);
  void set_fov(const RibSetting& setting);
  void set_search_path(const RibSetting& setting);
  void hider(const Call& call);
  void screen_window(const RibStatement& request, const std::vector<float>& numbers);
  void format(const RibStatement& request, const std::vector<float>& numbers);
  void shutter(const RibStatement& request, float open, float close);
  void camera_numbers(const Call& call);
  void display(const Call& call);
  void option(const Call& call);

  // geometry (rib_geometry_requests.cpp)
  void curves(const Call& call);
  void mesh(const Call& call);
  void patch(const Call& call);
  void quadric(const Call& call);
  void warn_of_curves(const RibStatement& request, const RibCurveSet& set);
  void warn_of_visibility(const RibStatement& request);
  void add_mesh(const Call& call, RibMesh mesh);
  /// Whether a transform has no inverse, such as Scale 0 0 0, which hides things. Warns of it once.
  bool is_flattened(const SourcePosition& position, const RibTransform& transform);
  void area_light(RibLight::Shape shape, float radius, std::vector<V3f> corners);
  /// What a material is on.
  struct Look {
    bool fibre = false, strand_color = false, strand_opacity = false;
  };
  std::string material_key(const Look& look) const;
  size_t material(const Look& look);
  void keep_batch(size_t coat, Strands batch);
  void count_points(const RibStatement& request, size_t points);
  std::string unique_name(const char* kind, std::string wanted);
  /// Of its shader's "string name", which `pelage rib` writes, else of the attribute "identifier".
  std::string light_name(const RibShader& shader);
  static StrandScale scale_of(const Strands& strands);

  // archives and procedurals (rib_archive_requests.cpp)
  void read_archive(const Call& call);
  void procedural(const Call& call);
  /// Returns a file beside the file of the request, beside the first file, or in `folders`; nullopt, after a
  /// warning, if there is none.
  std::optional<std::filesystem::path> find_file(const std::string& name,
                                                 const std::vector<std::string>& folders,
                                                 const RibStatement& request);
  void defer_archive(const std::filesystem::path& path, const RibStatement& request,
                     std::shared_ptr<const RibReply> reply);

  // procedurals that run code (rib_program_requests.cpp)
  /// A request to a program. Programs run one after the other, and not while another reply is read: that
  /// reply is read again for each of its batches, but the programs that it names are not asked again.
  struct WaitingProgram {
    RibStatement request;  ///< of a file of the user, also if a reply asks
    std::string command, line;
    RibAttributes attributes;
    size_t depth = 0;
  };
  void add_own_procedural(const std::string& arguments, const RibStatement& request);
  static bool is_own_procedural(const std::string& kind, const std::string& program);
  void foreign_procedural(const std::string& kind, const std::vector<std::string>& words, const Box3f& bound,
                          const RibStatement& request);
  void run_waiting_programs();
  void run_program(WaitingProgram waiting);
  float detail_of(const Box3f& bound) const;

  void ignore(const Call&) {}

  const RibReadOptions options_;
  RibContext context_;
  RibScene scene_;
  RibBatches::Take take_;
  RibBatches batches_;
  RibAttributes& now_ = context_.attributes;
  std::vector<Block> blocks_;
  std::vector<std::filesystem::path> reading_;  // files being read, from the outermost

  std::string skip_until_;  // a request that ends skipping; empty: not skipping
  bool frame_done_ = false, world_done_ = false;
  bool any_picture_ = false;  // each_frame was called with a frame

  bool in_motion_ = false;
  std::vector<double> times_;
  std::vector<RibStatement> samples_;

  std::string recording_;  // the request that ends the recording; empty: none
  std::string recorded_;   // key of the object
  std::map<std::string, std::vector<RibStatement>> objects_;
  const std::vector<RibStatement>* replayed_ = nullptr;  // of `objects_`; null outside instances
  SourcePosition opened_at_;                             // of the motion block or object
  std::deque<WaitingProgram> programs_;
  size_t program_depth_ = 0;              // replies around the one that is read
  const RibStatement* asking_ = nullptr;  // request to which the reply that is read belongs; null: none
  size_t largest_request_ = 0;            // bytes of the arguments, if more than 1 MiB
  size_t kept_bytes_ = 0, points_ = 0, archives_ = 0, inner_archives_ = 0, statements_ = 0;

  RibCamera camera_;
  /// What FrameEnd restores, beside the attributes. All but the camera is used with each_frame only.
  struct FrameState {
    RibCamera camera;
    RibScene scene;
    std::map<std::string, size_t> materials, coats;
    std::set<std::string> names;
    std::map<std::string, int> next_numbers;
    RibTransform world;
    std::optional<RibTransform> named_camera;
    size_t points = 0, archives = 0, inner_archives = 0;
  } before_frame_;
  bool in_deferred_ = false, stopped_ = false;
  std::map<std::string, size_t> materials_, coats_;  // by content
  std::set<std::string> names_, warned_;
  std::map<std::string, int> next_numbers_;  // of unique_name()
  struct Dropped {
    SourcePosition first;
    size_t count = 0;
  };
  std::map<std::string, Dropped> dropped_;
  std::optional<RibTransform> named_camera_;  // the request Camera
  bool skipped_shadows_ = false;              // some world draws a shadow map
};

}  // namespace pelage
