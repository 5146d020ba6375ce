// SPDX-License-Identifier: Apache-2.0
// Archives, and procedurals.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/nearest_name.h"
#include "geom/curve_bounds.h"
#include "procedurals/fixed_strands.h"
#include "rib/scene/rib_interpreter.h"

namespace pelage {
std::optional<std::filesystem::path> RibInterpreter::find_file(const std::string& name,
                                                               const std::vector<std::string>& search_path,
                                                               const RibStatement& request) {
  std::error_code ignored;
  if (name.empty() || name.find('\0') != std::string::npos) request.fail("expected the name of a file");
  const std::filesystem::path file(name);
  std::vector<std::filesystem::path> folders{std::filesystem::path(request.file).parent_path(),
                                             context_.folder};
  for (const std::string& folder : search_path) {
    folders.push_back(context_.folder / folder);
    folders.emplace_back(folder);
  }
  for (const std::filesystem::path& folder : folders) {  // `file` alone if it is absolute
    // A link that leads nowhere is found, and reading it says why.
    const auto status = std::filesystem::symlink_status(folder / file, ignored);
    if (std::filesystem::exists(status)) return (folder / file).lexically_normal();
  }
  warn_once("file " + name, request.position(),
            request.name + ": no such file " + quote(name) +
                (file.is_absolute() ? "" : " beside the file or on the search path") + "; skipped");
  return {};
}

void RibInterpreter::read_archive(const Call& call) {
  RibStatement request = call.request();  // reading an archive reuses the memory of the request
  if (request.arguments.empty() || request.arguments[0].is_number())
    request.fail("expected the name of a file");
  const std::string& name = request.arguments[0].strings[0];
  if (const auto inline_archive = objects_.find(name); inline_archive != objects_.end()) {
    instance({std::span(&request, 1), {}});
    return;
  }
  if (const auto file = find_file(name, context_.search_path, request)) read_file(*file, &request);
}

void RibInterpreter::procedural(const Call& call) {
  RibStatement request = call.request();
  if (request.arguments.empty() || request.arguments[0].is_number())
    request.fail("expected a kind of procedural");
  const std::string kind = request.arguments[0].strings[0];
  std::vector<std::string> words;  // file, program or plugin, and its arguments
  Box3f bound;
  if (request.name == "Procedural") {
    if (request.arguments.size() != 3 || request.arguments[1].is_number() || request.arguments[1].size() == 0)
      request.fail("expected a kind, an array of strings and a bound of six numbers");
    const RibOperand& box = request.arguments[2];
    if (!box.is_number() || box.size() != 6)
      request.fail(box, "a bound is six numbers, got " + box.describe());
    words = request.arguments[1].strings;
    bound = Box3f(V3f(box.number(0), box.number(2), box.number(4)),
                  V3f(box.number(1), box.number(3), box.number(5)));
  } else {
    std::string file, data;
    for (const RibSetting& setting : settings_of(request, 2)) {
      if (setting.strings.size() != 1) continue;
      if (setting.name == "filename" || setting.name == "dsoname" || setting.name == "programname")
        file = setting.strings[0];
      if (setting.name == "data") data = setting.strings[0];
    }
    words = {file, data};
  }
  words.resize(std::max<size_t>(words.size(), 2));
  if (kind == "DelayedReadArchive" || kind == "DelayedReadArchive2") {
    if (const auto file = find_file(words[0], context_.search_path, request)) {
      defer_archive(*file, request, nullptr);
      run_waiting_programs();
    }
  } else if (is_own_procedural(kind, words[0])) {
    add_own_procedural(words[1], request);
  } else {
    foreign_procedural(kind, words, bound, request);
  }
}

// The archive is executed now, in place. Its meshes and lights are kept; of each batch of its strands, only
// the size and the box are kept.
void RibInterpreter::defer_archive(const std::filesystem::path& path, const RibStatement& request,
                                   std::shared_ptr<const RibReply> reply) {
  if (!options_.geometry || in_deferred_) {
    const RibAttributes saved = now_;
    read_file(path, &request);
    now_ = saved;
    return;
  }
  auto archive = std::make_shared<RibDeferredArchive>();
  archive->path = path;
  archive->reply = std::move(reply);
  archive->context = context_;
  // Batches of the archive are not mixed with those of the file around it.
  batches_.finish();
  size_t number = 0;
  in_deferred_ = true;
  take_ = [&](size_t coat, Strands batch) {
    RibCoat& own = scene_.coats[coat];
    if (own.scale.width == 0) own.scale = scale_of(batch);
    own.deferred.push_back({archive, number++, counts_of(batch), exact_bounds(batch)});
  };
  const RibAttributes saved = now_;
  const size_t largest = largest_request_;
  largest_request_ = 0;
  read_file(path, &request);
  archive->request_bytes = largest_request_;
  largest_request_ = std::max(largest, largest_request_);
  now_ = saved;
  batches_.finish();
  take_ = nullptr;
  in_deferred_ = false;
}

StrandScale RibInterpreter::scale_of(const Strands& strands) {
  float width = 0;
  for (size_t i = 0; i < strands.point_count(); ++i) width = std::max(width, 2 * strands.radius(i));
  width = std::max(width, 1e-6f);
  return {width, strands.point(0), width};
}

}  // namespace pelage
